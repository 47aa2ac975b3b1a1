#include "forces/face_force.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

TEST(FaceForce, TheWrenchIsTheirSumAndThatOfTheirTorques) {
  std::vector<FaceForce> forces(2);
  forces[0].place = {0.1, 0.0, 0.0};
  forces[0].force = {0.0, 2.0, 0.5};
  forces[1].place = {0.0, 0.0, 0.3};
  forces[1].force = {1.0, -4.0, 0.0};
  const geometry_msgs::Wrench wrench = wrench_of(forces);
  EXPECT_DOUBLE_EQ(wrench.force.x, 1.0);
  EXPECT_DOUBLE_EQ(wrench.force.y, -2.0);
  EXPECT_DOUBLE_EQ(wrench.force.z, 0.5);
  EXPECT_DOUBLE_EQ(wrench.torque.x, 1.2);
  EXPECT_DOUBLE_EQ(wrench.torque.y, -0.05 + 0.3);
  EXPECT_DOUBLE_EQ(wrench.torque.z, 0.2);
}

TEST(FaceForce, OfNoneItIsZero) { EXPECT_EQ(wrench_of({}), geometry_msgs::Wrench()); }
