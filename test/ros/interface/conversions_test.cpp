#include "ros/interface/conversions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

class Conversions : public testing::Test {
 protected:
  Vector3d point() { return {number(random_), number(random_), number(random_)}; }
  geometry_msgs::Point message_point() { return to_point(point()); }

  std::mt19937 random_{3};
  std::normal_distribution<double> number{0.3, 2.0};
  double number_of(std::mt19937& random) { return number(random); }
};

}  // namespace

TEST_F(Conversions, PointsThereAndBack) {
  const Vector3d p = point();
  const geometry_msgs::Point message = to_point(p);
  EXPECT_EQ(message.x, p.x());
  EXPECT_EQ(message.y, p.y());
  EXPECT_EQ(message.z, p.z());
  EXPECT_EQ(to_eigen(message), p);
  EXPECT_EQ(to_vector(p).z, p.z());
}

TEST_F(Conversions, TransformTurnsThenMoves) {
  geometry_msgs::Transform transform;
  transform.translation.x = 1.0;
  transform.translation.y = 2.0;
  transform.translation.z = 3.0;
  // A quarter turn about z, and not quite unit, as senders round it.
  transform.rotation.z = 0.70711;
  transform.rotation.w = 0.70711;
  const Vector3d moved = to_eigen(transform) * Vector3d(0.1, 0.2, 0.3);
  EXPECT_TRUE(moved.isApprox(Vector3d(0.8, 2.1, 3.3), 1e-12)) << moved.transpose();
}

TEST_F(Conversions, EveryFieldOfAContact) {
  FaceContact contact;
  contact.face = 4000000000u;
  contact.link = 7;
  contact.fraction = 0.25;
  contact.point = {1.0, 2.0, 3.0};
  contact.normal = {0.6, 0.0, -0.8};
  contact.barycentric = {0.2, 0.3, 0.5};
  contact.shaft = 0.75;
  contact.depth = -0.001;
  contact.behind = true;
  contact.view_min = 0.01;
  contact.view_max = 0.02;
  const Contact message = to_message(contact);
  EXPECT_EQ(message.face, 4000000000u);
  EXPECT_EQ(message.link, 7u);
  EXPECT_EQ(message.fraction, 0.25);
  EXPECT_EQ(to_eigen(message.point), contact.point);
  EXPECT_EQ(message.normal.x, 0.6);
  EXPECT_EQ(message.normal.z, -0.8);
  EXPECT_EQ(message.barycentric[0], 0.2);
  EXPECT_EQ(message.barycentric[2], 0.5);
  EXPECT_EQ(message.shaft, 0.75);
  EXPECT_EQ(message.depth, -0.001);
  EXPECT_TRUE(message.behind);
  EXPECT_EQ(message.view_min, 0.01);
  EXPECT_EQ(message.view_max, 0.02);
}

TEST_F(Conversions, RegionKeepsItsCorners) {
  const geometry_msgs::Polygon polygon = to_message(Region{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.5}});
  ASSERT_EQ(polygon.points.size(), 2u);
  EXPECT_EQ(polygon.points[1].y, 5.0f);
  EXPECT_EQ(polygon.points[1].z, 6.5f);
  EXPECT_TRUE(to_message(Region{}).points.empty());
}

TEST_F(Conversions, PathIsMovedIntoTheFrame) {
  ToolMotion motion;
  motion.previous_trocar = message_point();
  motion.previous_tip = message_point();
  motion.trocar = message_point();
  motion.tip = message_point();
  const Eigen::Isometry3d T =
      Eigen::Translation3d(point()) * Eigen::AngleAxisd(0.7, Vector3d(1.0, -2.0, 0.5).normalized());
  const ToolPath path = to_path(motion, false, T);
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[0].fraction, 0.0);
  EXPECT_EQ(path[1].fraction, 1.0);
  EXPECT_EQ(path[0].axis.trocar, T * to_eigen(motion.previous_trocar));
  EXPECT_EQ(path[0].axis.tip, T * to_eigen(motion.previous_tip));
  EXPECT_EQ(path[1].axis.trocar, T * to_eigen(motion.trocar));
  EXPECT_EQ(path[1].axis.tip, T * to_eigen(motion.tip));
}

TEST_F(Conversions, PathOfTheEndAlone) {
  ToolMotion motion;
  motion.previous_tip.x = std::nan("");  // unused
  motion.tip = message_point();
  const ToolPath path = to_path(motion, true, Eigen::Isometry3d::Identity());
  ASSERT_EQ(path.size(), 1u);
  EXPECT_EQ(path[0].axis.tip, to_eigen(motion.tip));
}

TEST_F(Conversions, FrameWithoutLeadingSlash) {
  EXPECT_EQ(tf_frame("/liver"), "liver");
  EXPECT_EQ(tf_frame("liver"), "liver");
  EXPECT_EQ(tf_frame("robot/tip"), "robot/tip");
  EXPECT_EQ(tf_frame("/"), "");
  EXPECT_EQ(tf_frame(""), "");
}
