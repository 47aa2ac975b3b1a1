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

}  // namespace
}  // namespace organ_collision
