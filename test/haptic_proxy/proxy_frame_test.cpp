#include "haptic_proxy/proxy_frame.hpp"

#include "test/ros/organs/organ_registry_fixture.hpp"

using namespace organ_collision;

namespace {

class ProxyFrameTest : public OrganRegistryTest {
 protected:
  void send(const std::string& organ, const std::string& frame) {
    OrganMesh message = mesh(organ);
    message.header.frame_id = frame;
    apply(message, ros::Time(9));
  }
  void remove(const std::string& organ) {
    OrganMesh message;
    message.organ = organ;
    apply(message, ros::Time(9));
  }
};

}  // namespace

TEST_F(ProxyFrameTest, IsThatOfTheFirstOrganAndStays) {
  ProxyFrame frame("");
  EXPECT_FALSE(frame.update(store_));
  EXPECT_EQ(frame.name(), "");
  send("liver", "liver_frame");
  EXPECT_TRUE(frame.update(store_));
  EXPECT_EQ(frame.name(), "liver_frame");
  send("kidney", "kidney_frame");
  EXPECT_FALSE(frame.update(store_)) << "the name of another organ comes first, but it came later";
  remove("liver");
  EXPECT_TRUE(frame.update(store_));
  EXPECT_EQ(frame.name(), "kidney_frame");
  remove("kidney");
  EXPECT_FALSE(frame.update(store_));
  EXPECT_EQ(frame.name(), "kidney_frame");
}

TEST_F(ProxyFrameTest, AFixedFrameIsNeverChanged) {
  ProxyFrame frame("world");
  send("liver", "liver_frame");
  EXPECT_FALSE(frame.update(store_));
  EXPECT_EQ(frame.name(), "world");
}
