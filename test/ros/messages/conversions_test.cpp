#include "ros/messages/conversions.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

const Vector3d kVector(0.3, -2.5, 1e-7);

}  // namespace

TEST(Conversions, PointsThereAndBack) {
  const geometry_msgs::Point message = tf2::toMsg(kVector);
  EXPECT_EQ(message.x, 0.3);
  EXPECT_EQ(message.y, -2.5);
  EXPECT_EQ(message.z, 1e-7);
  EXPECT_EQ(to_eigen(message), kVector);
}

TEST(Conversions, VectorsThereAndBack) {
  const geometry_msgs::Vector3 message = to_vector(kVector);
  EXPECT_EQ(message.x, 0.3);
  EXPECT_EQ(message.y, -2.5);
  EXPECT_EQ(message.z, 1e-7);
  EXPECT_EQ(to_eigen(message), kVector);
}

TEST(Conversions, TransformTurnsThenMoves) {
  geometry_msgs::Transform transform;
  transform.translation.x = 1.0;
  transform.translation.y = 2.0;
  transform.translation.z = 3.0;
  // A quarter turn about z; the quaternion is not exactly unit, as senders round it.
  transform.rotation.z = 0.70711;
  transform.rotation.w = 0.70711;
  const Vector3d moved = to_eigen(transform) * Vector3d(0.1, 0.2, 0.3);
  EXPECT_TRUE(moved.isApprox(Vector3d(0.8, 2.1, 3.3), 1e-12)) << moved.transpose();
}

TEST(Conversions, PoseTurnsThenMoves) {
  geometry_msgs::Pose pose;
  pose.position.x = 1.0;
  pose.position.y = 2.0;
  pose.position.z = 3.0;
  pose.orientation.z = pose.orientation.w = 0.70711;
  const Vector3d moved = to_eigen(pose) * Vector3d(0.1, 0.2, 0.3);
  EXPECT_TRUE(moved.isApprox(Vector3d(0.8, 2.1, 3.3), 1e-12)) << moved.transpose();
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
  EXPECT_EQ(tf_frame("/liver"), "liver");
  EXPECT_EQ(tf_frame("liver"), "liver");
  EXPECT_EQ(tf_frame("robot/tip"), "robot/tip");
  EXPECT_EQ(tf_frame("/"), "");
  EXPECT_EQ(tf_frame(""), "");
}

using namespace organ_collision;

namespace {

Eigen::AlignedBox3d box(double x, double y, double z) {
  const Eigen::Vector3d low(0.3, -7.0, 0.1);
  return {low, low + Eigen::Vector3d(x, y, z)};
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' in: " << text;
  }
}

}  // namespace

TEST(PlausibleSize, SidesHaveThreeDigits) {
  EXPECT_EQ(sides_of(box(0.12, 0.09, 0.061234)), "0.12 x 0.09 x 0.0612");
}

TEST(PlausibleSize, OrgansByTheirLongestSide) {
  EXPECT_EQ(doubt_about_organ("kidney", box(0.12, 0.09, 0.06)), "");
  EXPECT_EQ(doubt_about_organ("sheet", box(0.0, 0.1, 0.1)), "");
  EXPECT_EQ(doubt_about_organ("body", box(0.5, 1.9, 0.4)), "");
  expect_words(doubt_about_organ("kidney", box(90, 120, 60)),
               {"organ 'kidney' is 90 x 120 x 60 m", "0.001 to 3 m", "are these millimetres?"});
  expect_words(doubt_about_organ("kidney", box(9e-5, 1e-4, 6e-5)),
               {"organ 'kidney'", "0.0001", "twice?"});
  EXPECT_NE(doubt_about_organ("point", box(0, 0, 0)), "");
}

TEST(PlausibleSize, Radii) {
  for (const double radius : {1e-4, 0.005, 0.05}) EXPECT_EQ(doubt_about_radius("hook", radius), "");
  expect_words(doubt_about_radius("hook", 5.0),
               {"tool 'hook' has a radius of 5 m", "2e-05 to 0.1 m", "are these millimetres?"});
  expect_words(doubt_about_radius("hook", 5e-6), {"5e-06 m", "twice?"});
}
