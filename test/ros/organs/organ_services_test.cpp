#include "ros/organs/organ_services.hpp"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>
#include <future>

#include "test/ros/organs/solids.hpp"

using namespace organ_collision;

namespace {

/// This thread is the node's thread. Another one takes the place of the background thread.
class OrganServicesTest : public testing::Test {
 protected:
  OrganServicesTest() {
    ros::Time::init();
    ros::Time::setNow(ros::Time(50.0));
  }

  void send(const std::string& organ) {
    const auto mesh = boost::make_shared<OrganMesh>();
    mesh->header.frame_id = "frame";
    mesh->organ = organ;
    mesh->vertices = corners();
    mesh->triangles = kOutward;
    topics_.take_mesh(mesh);
    apply();
  }
  void apply() {
    while (topics_.next()) {
    }
  }

  ListOrgans::Response list() {
    const auto call = [this] {
      ListOrgans::Request request;
      ListOrgans::Response response;
      EXPECT_TRUE(services_.on_list(request, response));
      return response;
    };
    std::future<ListOrgans::Response> answer = std::async(std::launch::async, call);
    node_queue_.callOne(ros::WallDuration(20.0));
    return answer.get();
  }
  RemoveOrgan::Response remove(const std::string& organ) {
    RemoveOrgan::Request request;
    request.name = organ;
    RemoveOrgan::Response response;
    EXPECT_TRUE(services_.on_remove(request, response));
    return response;
  }

  ros::CallbackQueue node_queue_, background_;
  OrganRegistry organs_{MeshLimits{}};
  FailureLog rejected_;
  OrganTopics topics_{organs_, rejected_, node_queue_};
  OrganServices services_{{organs_, topics_, node_queue_, background_}};
};

}  // namespace

TEST_F(OrganServicesTest, ListsWhatTheNodeHas) {
  EXPECT_TRUE(list().organs.empty());
  send("spleen");
  send("kidney");
  const auto organs = list().organs;
  ASSERT_EQ(organs.size(), 2u);
  EXPECT_EQ(organs[0].name, "kidney");
  EXPECT_TRUE(organs[0].closed);
  EXPECT_GT(organs[0].volume, 0.0);
  EXPECT_EQ(organs[1].name, "spleen");
}

TEST_F(OrganServicesTest, RemovesAnOrgan) {
  send("kidney");
  const RemoveOrgan::Response removed = remove("kidney");
  EXPECT_TRUE(removed.success);
  EXPECT_EQ(removed.message, "organ 'kidney' is removed");
  apply();
  EXPECT_TRUE(list().organs.empty());
}

TEST_F(OrganServicesTest, RefusesToRemoveWhatIsNotThere) {
  send("kidney");
  const RemoveOrgan::Response unknown = remove("liver");
  EXPECT_FALSE(unknown.success);
  EXPECT_EQ(unknown.message, "organ 'liver' is unknown; known are 'kidney'");
  EXPECT_FALSE(remove("").success);
  EXPECT_FALSE(remove("\xFF").success);
  apply();
  EXPECT_EQ(organs_.organs().size(), 1u);
}
