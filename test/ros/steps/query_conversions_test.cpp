#include "ros/steps/query_conversions.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>
#include <random>

#include "ros/interface/conversions.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

geometry_msgs::Point random_point(std::mt19937& random) {
  std::normal_distribution<double> number(0.3, 2.0);
  const double x = number(random), y = number(random), z = number(random);
  return tf2::toMsg(Vector3d(x, y, z));
}

}  // namespace

TEST(QueryConversions, EveryFieldOfAContact) {
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

TEST(QueryConversions, RegionKeepsItsCorners) {
  const geometry_msgs::Polygon polygon = to_message(Region{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.5}});
  ASSERT_EQ(polygon.points.size(), 2u);
  EXPECT_EQ(polygon.points[1].y, 5.0f);
  EXPECT_EQ(polygon.points[1].z, 6.5f);
  EXPECT_TRUE(to_message(Region{}).points.empty());
}

TEST(QueryConversions, PathIsMovedIntoTheFrame) {
  std::mt19937 random(3);
  ToolMotion motion;
  motion.previous_trocar = random_point(random);
  motion.previous_tip = random_point(random);
  motion.trocar = random_point(random);
  motion.tip = random_point(random);
  const Eigen::Isometry3d T = Eigen::Translation3d(to_eigen(random_point(random))) *
                              Eigen::AngleAxisd(0.7, Vector3d(1.0, -2.0, 0.5).normalized());
  const ToolPath path = to_path(motion, false, T);
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[0].fraction, 0.0);
  EXPECT_EQ(path[1].fraction, 1.0);
  EXPECT_EQ(path[0].axis.trocar, T * to_eigen(motion.previous_trocar));
  EXPECT_EQ(path[0].axis.tip, T * to_eigen(motion.previous_tip));
  EXPECT_EQ(path[1].axis.trocar, T * to_eigen(motion.trocar));
  EXPECT_EQ(path[1].axis.tip, T * to_eigen(motion.tip));
}

TEST(QueryConversions, PathOfTheEndAlone) {
  std::mt19937 random(3);
  ToolMotion motion;
  motion.previous_tip.x = std::nan("");  // not used
  motion.tip = random_point(random);
  const ToolPath path = to_path(motion, true, Eigen::Isometry3d::Identity());
  ASSERT_EQ(path.size(), 1u);
  EXPECT_EQ(path[0].axis.tip, to_eigen(motion.tip));
}
