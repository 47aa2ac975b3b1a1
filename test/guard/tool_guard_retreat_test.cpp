// The way out that ToolGuard gives.
#include "common/messages/conversions.hpp"
#include "tool_guard_fixture.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

class ToolGuardRetreatTest : public ToolGuardTest {
 protected:
  /// The way out of an answer at 0.5 mm, after a change of the answer.
  Vector3d way(const std::function<void(ContactArray&)>& change) {
    time_ += 1.0;
    list({organ("liver")});
    ContactArray a = answer(0.0005);
    change(a);
    return to_eigen(after(a).retreat);
  }
};

TEST_F(ToolGuardRetreatTest, TheWayOut) {
  const Vector3d up(0, 0, 1), none(0, 0, 0);
  const auto inside = [](auto& a) { a.placement.tip = ToolPlacement::INSIDE; };
  const auto pierced = [](auto& a) { a.placement.crossings.resize(2); };
  EXPECT_EQ(way([](auto&) {}), -up);
  EXPECT_EQ(way(inside), outward_);
  EXPECT_EQ(way(pierced), outward_);
  EXPECT_EQ(way([](auto& a) { a.placement.tip = a.placement.trocar = ToolPlacement::INSIDE; }),
            none);
  EXPECT_EQ(way([](auto& a) { a.status = ContactArray::STALE_MESH; }), none);
  EXPECT_EQ(way([](auto& a) { a.header.stamp -= ros::Duration(1.0); }), none);
  EXPECT_EQ(way([](auto& a) { a.unresolved = 1; }), none);
  ToolInfo free = tool_;
  free.radius = 0.0;
  free.tip_frame = "tip";
  guard_.set_tool(free);
  EXPECT_EQ(way([](auto&) {}), -up);
  EXPECT_EQ(way(inside), up) << "towards the nearest place, and through";
  EXPECT_EQ(way([](auto& a) { a.placement.tip = ToolPlacement::UNKNOWN; }), none);
  EXPECT_EQ(way([](auto& a) { a.clearance.normal_defined = 0, a.near.clear(); }), none);
  parameters_.keep = {{"liver", KeptSide::kInside}};
  EXPECT_EQ(way(inside), -up);
  EXPECT_EQ(way([](auto&) {}), up);
}

TEST_F(ToolGuardRetreatTest, AnotherOrganMayCloseTheWayOut) {
  list({organ("liver"), organ("colon")});
  const auto out_beside = [&](double distance, double z, const std::string& frame) {
    time_ += 1.0;
    ContactArray other = answer(distance, 0.0, "colon");
    other.clearance.normal = other.near[0].normal = vector(0, 0, z);
    other.header.frame_id = frame;
    take(other);
    return after(answer(0.0005)).retreat.z;
  };
  EXPECT_EQ(out_beside(0.02, -1.0, "other"), -1.0) << "it is far";
  EXPECT_EQ(out_beside(0.0012, -1.0, "world"), 0.0) << "it is on the other side";
  EXPECT_EQ(out_beside(0.0012, 1.0, "world"), -1.0) << "it is on the same side";
  EXPECT_EQ(out_beside(0.0012, 1.0, "other"), 0.0) << "its direction is not known";
}

}  // namespace
}  // namespace organ_collision
