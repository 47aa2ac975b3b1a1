#include "common/messages/conversions.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

TEST(Conversions, TransformsAndPosesTurnThenMove) {
  geometry_msgs::Transform transform;
  transform.translation = to_vector({1.0, 2.0, 3.0});
  // A quarter turn about z; the quaternion is not exactly unit, as senders round it.
  transform.rotation.z = 0.70711;
  transform.rotation.w = 0.70711;
  geometry_msgs::Pose pose;
  pose.position = tf2::toMsg(Vector3d(1.0, 2.0, 3.0));
  pose.orientation = transform.rotation;
  for (const Eigen::Isometry3d& found : {to_eigen(transform), to_eigen(pose)}) {
    const Vector3d moved = found * Vector3d(0.1, 0.2, 0.3);
    EXPECT_TRUE(moved.isApprox(Vector3d(0.8, 2.1, 3.3), 1e-12)) << moved.transpose();
  }
}

TEST(Conversions, LengthOfAQuaternion) {
  geometry_msgs::Quaternion quaternion;
  EXPECT_FALSE(is_unit(quaternion));
  quaternion.x = 0.6;
  quaternion.z = -0.8;
  EXPECT_TRUE(is_unit(quaternion));
  quaternion.z = -0.8008;
  EXPECT_TRUE(is_unit(quaternion));
  quaternion.z = -0.802;
  EXPECT_FALSE(is_unit(quaternion));
  quaternion.z = std::nan("");
  EXPECT_FALSE(is_unit(quaternion));
}

TEST(Conversions, FrameWithoutLeadingSlash) {
  for (const auto& [given, frame] :
       {std::pair("/liver", "liver"), std::pair("liver", "liver"),
        std::pair("robot/tip", "robot/tip"), std::pair("/", ""), std::pair("", "")}) {
    EXPECT_EQ(tf_frame(given), frame);
  }
}

Eigen::AlignedBox3d box(double x, double y, double z) {
  const Eigen::Vector3d low(0.3, -7.0, 0.1);
  return {low, low + Eigen::Vector3d(x, y, z)};
}

TEST(Clock, ItsEndsAreNoErrors) {
  const ros::Time last(4294967295, 999999999);
  EXPECT_EQ(later(ros::Time(10.0), 0.5), ros::Time(10.5));
  EXPECT_EQ(later(ros::Time(2147483647.0), 1.0), ros::Time(2147483648.0));
  for (const ros::Time time : {ros::Time(), ros::Time(4294967295.0), last}) {
    EXPECT_EQ(later(time, 1e12), last);
  }
  for (const ros::Time now : {ros::Time(), ros::Time(4294966999.5), last}) {
    EXPECT_NE(AheadLimit(1e9).fault(ros::Time(4294967001.0), now).find("at most 4294967000"),
              std::string::npos);
    EXPECT_EQ(AheadLimit(1.0).fault(ros::Time(4294966999.9), now), "");
  }
}

TEST(PlausibleSize, OrgansByTheirLongestSideAndShaftsByTheirRadius) {
  const std::string lengths = " m. Lengths are in metres: ", large = "are these millimetres?",
                    small = "were they converted from millimetres twice?";
  const std::string of_organs = "; plausible are 0.001 to 3" + lengths,
                    of_radii = "; plausible are 2e-05 to 0.1" + lengths;
  EXPECT_EQ(sides_of(box(0.12, 0.09, 0.061234)), "0.12 x 0.09 x 0.0612");
  for (const auto& [sides, doubt] :
       {std::pair(box(0.12, 0.09, 0.06), std::string()),
        std::pair(box(0.0, 0.1, 0.1), std::string()), std::pair(box(0.5, 1.9, 0.4), std::string()),
        std::pair(box(90, 120, 60), "organ 'liver' is 90 x 120 x 60 m large" + of_organs + large),
        std::pair(box(0, 0, 0), "organ 'liver' is 0 x 0 x 0 m large" + of_organs + small)}) {
    EXPECT_EQ(doubt_about_organ("liver", sides), doubt);
  }
  for (const double radius : {1e-4, 0.005, 0.05})
    EXPECT_EQ(doubt_about_radius("tool 'hook'", radius), "");
  EXPECT_EQ(doubt_about_radius("tool 'hook'", 5.0),
            "tool 'hook' has a radius of 5 m" + of_radii + large);
  EXPECT_EQ(doubt_about_radius("tool 'hook'", 5e-6),
            "tool 'hook' has a radius of 5e-06 m" + of_radii + small);
  EXPECT_EQ(doubt_about_distance("hook", "liver", 0.0), "");
  EXPECT_EQ(doubt_about_distance("hook", "liver", 9.0), "");
  EXPECT_EQ(doubt_about_distance("hook", "liver", 100.0),
            "tool 'hook' is 100 m away from organ 'liver'; plausible are 0 to 10 m. Lengths are in "
            "metres: are these millimetres?");
  EXPECT_EQ(doubt_about_link("hook", "jaw", 0.02), "");
  EXPECT_EQ(doubt_about_link("hook", "jaw", 20.0),
            "link 'jaw' of tool 'hook' is 20 m long; plausible are 0.0002 to 3" + lengths + large);
}

}  // namespace
}  // namespace organ_collision
