#include "haptic_proxy/proxy_report.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include "test/ros/tools/hand_made_tools.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

TEST(PoseOf, AShaftsZAxisPointsFromTrocarToTip) {
  const Vector3d trocar(0.02, -0.1, 0.3), tip(-0.05, 0.07, 0.11);
  Eigen::Isometry3d pose;
  tf2::fromMsg(pose_of(shaft_tool("hook", 0.004).parameters, {{trocar, tip}}), pose);
  EXPECT_LT((pose.translation() - tip).norm(), 1e-12);
  EXPECT_LT((pose.linear().col(2) - (tip - trocar).normalized()).norm(), 1e-12);
}

TEST(PoseOf, AToolWithoutAShaftHasThePoseOfItsFirstLink) {
  Eigen::Isometry3d wrist = Eigen::Translation3d(0.4, 0.5, -0.6) *
                            Eigen::AngleAxisd(1.1, Vector3d(0.3, -0.5, 0.8).normalized());
  Eigen::Isometry3d pose;
  tf2::fromMsg(pose_of(grasper().parameters, {{Vector3d::Zero(), Vector3d::Zero()},
                                              {wrist, Eigen::Isometry3d::Identity()}}),
               pose);
  EXPECT_TRUE(pose.isApprox(wrist, 1e-12));
}
