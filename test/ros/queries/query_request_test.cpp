#include "ros/queries/query_request.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "ros/messages/conversions.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

OrganShape shape(float z) {
  OrganShape shape;
  shape.mesh =
      std::make_shared<const TriangleMesh>(TriangleMesh({-1, -1, z, 1, -1, z, 1, 1, z}, {0, 1, 2}));
  shape.surface = std::make_shared<OrganSurface>(*shape.mesh);
  return shape;
}

/// A snapshot of an organ that has moved, and of a hook.
QuerySnapshot moved() {
  QuerySnapshot snapshot;
  snapshot.latest = shape(0.0F);
  snapshot.previous = shape(1.0F);
  snapshot.tool = with_links(shaft_tool("hook", 0.01));
  return snapshot;
}

Vector3d random_vector(std::mt19937& random) {
  std::normal_distribution<double> number(0.3, 2.0);
  const double x = number(random), y = number(random), z = number(random);
  return {x, y, z};
}

geometry_msgs::Point random_point(std::mt19937& random) {
  return tf2::toMsg(random_vector(random));
}

Eigen::Isometry3d random_transform(std::mt19937& random) {
  return Eigen::Translation3d(random_vector(random)) *
         Eigen::AngleAxisd(0.7, random_vector(random).normalized());
}

ToolMotion random_motion(std::mt19937& random) {
  ToolMotion motion;
  motion.previous_trocar = random_point(random);
  motion.previous_tip = random_point(random);
  motion.trocar = random_point(random);
  motion.tip = random_point(random);
  motion.radius = 0.25;
  return motion;
}

CollisionRequest in_mode(QueryMode mode) {
  CollisionRequest request;
  request.mode = mode;
  return request;
}

}  // namespace

TEST(QueryRequest, WhatIsAskedReachesTheQuery) {
  QueryCollision::Request request;
  request.mode = ContactArray::SWEPT;
  request.regions = request.clearance = 1;
  request.margin = 0.25;
  request.max_near = 7;
  const CollisionRequest full = checked_request(request);
  EXPECT_EQ(full.mode, QueryMode::kSwept);
  EXPECT_TRUE(full.regions && full.clearance);
  EXPECT_EQ(full.margin, 0.25);
  EXPECT_EQ(full.max_near, 7u);
  const CollisionRequest plain = checked_request(QueryCollision::Request());
  EXPECT_EQ(plain.mode, QueryMode::kStatic);
  EXPECT_FALSE(plain.regions || plain.clearance || plain.placement);

  QueryCollisionBatch::Request batch;
  batch.mode = ContactArray::SWEPT;
  batch.margin = 0.5;
  batch.placement = 1;
  const CollisionRequest of_batch = checked_request(batch);
  EXPECT_EQ(of_batch.mode, QueryMode::kSwept);
  EXPECT_EQ(of_batch.margin, 0.5);
  EXPECT_TRUE(of_batch.placement);
}

TEST(QueryRequest, TheOrganMovesInSweptQueriesAlone) {
  const QuerySnapshot snapshot = moved();
  for (int mode = 0; mode <= ContactArray::PAPER_NAIVE; ++mode) {
    CollisionRequest request = in_mode(static_cast<QueryMode>(mode));
    set_subject(snapshot, false, request);
    EXPECT_EQ(request.organ, snapshot.latest.mesh.get());
    EXPECT_EQ(request.organ_before, nullptr);
    EXPECT_EQ(request.radius, 0.01);
    EXPECT_EQ(request.links, &snapshot.tool->links);
    set_subject(snapshot, true, request);
    const bool moves = request.organ_before == snapshot.previous.mesh.get();
    EXPECT_EQ(moves, mode == ContactArray::SWEPT) << mode;
  }
}

TEST(QueryRequest, SidesWaitForTheInspectionOfTheSurface) {
  const QuerySnapshot snapshot = moved();
  CollisionRequest request;
  request.placement = true;
  set_subject(snapshot, false, request);
  EXPECT_EQ(request.surface_topology, nullptr);
  std::thread inspector([&] { snapshot.latest.surface->find(); });
  snapshot.latest.surface->wait_until_found(std::chrono::minutes(1));
  inspector.join();
  set_subject(snapshot, false, request);
  EXPECT_EQ(request.surface_topology, &snapshot.latest.surface->topology());
}

TEST(GivenMotion, OfAShaftIsMovedIntoTheOrgansFrame) {
  std::mt19937 random(3);
  ToolMotion motion = random_motion(random);
  QuerySnapshot snapshot;
  snapshot.T_organ_motion = random_transform(random);
  const Eigen::Isometry3d& T = snapshot.T_organ_motion;
  CollisionRequest request = in_mode(QueryMode::kSwept);
  set_motion({&motion, nullptr}, snapshot, request);
  const ToolPath& path = request.path;
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[0].fraction, 0.0);
  EXPECT_EQ(path[1].fraction, 1.0);
  EXPECT_EQ(path[0].axis.trocar, T * to_eigen(motion.previous_trocar));
  EXPECT_EQ(path[0].axis.tip, T * to_eigen(motion.previous_tip));
  EXPECT_EQ(path[1].axis.trocar, T * to_eigen(motion.trocar));
  EXPECT_EQ(path[1].axis.tip, T * to_eigen(motion.tip));
  EXPECT_EQ(request.radius, 0.25);

  request.mode = QueryMode::kStatic;
  motion.previous_tip.x = std::nan("");  // Not used.
  set_motion({&motion, nullptr}, snapshot, request);
  ASSERT_EQ(request.path.size(), 1u);
  EXPECT_EQ(request.path[0].axis.tip, T * to_eigen(motion.tip));
}

TEST(GivenMotion, OfShaftAndLinks) {
  std::mt19937 random(5);
  QuerySnapshot snapshot = moved();
  snapshot.T_organ_motion = random_transform(random);
  ToolMotion shaft = random_motion(random);
  shaft.radius = 0.0;
  LinkMotion links;
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 4; ++i) {
    poses.push_back(random_transform(random));
    geometry_msgs::Pose pose = tf2::toMsg(poses.back());
    pose.orientation.x *= 1.0005;  // Senders round. It is normalised.
    pose.orientation.y *= 1.0005;
    pose.orientation.z *= 1.0005;
    pose.orientation.w *= 1.0005;
    (i < 2 ? links.previous : links.links).push_back(pose);
  }
  CollisionRequest request = in_mode(QueryMode::kSwept);
  set_motion({&shaft, &links}, snapshot, request);
  ASSERT_EQ(request.path.size(), 2u);
  EXPECT_EQ(request.path[1].axis.tip, snapshot.T_organ_motion * to_eigen(shaft.tip));
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Isometry3d& pose = request.path[i / 2].links.at(i % 2);
    EXPECT_TRUE(pose.isApprox(snapshot.T_organ_motion * poses[i], 1e-14)) << i;
  }
  request.mode = QueryMode::kStatic;
  links.previous.clear();
  set_motion({&shaft, &links}, snapshot, request);
  ASSERT_EQ(request.path.size(), 1u);
  EXPECT_TRUE(request.path[0].links.at(1).isApprox(snapshot.T_organ_motion * poses[3], 1e-14));
}

TEST(GivenMotion, TheTipOfLinksIsKnownIfALinkHasItsFrame) {
  std::mt19937 random(7);
  QuerySnapshot snapshot;
  snapshot.T_organ_motion = random_transform(random);
  snapshot.tool = grasper();
  LinkMotion links;
  for (int i = 0; i < 2; ++i) links.links.push_back(tf2::toMsg(random_transform(random)));
  CollisionRequest request = in_mode(QueryMode::kStatic);
  const auto tip = [&](const std::string& frame) {
    snapshot.tool->parameters.tip_frame = frame;
    request.tip = Vector3d(1.0, 2.0, 3.0);
    set_motion({nullptr, &links}, snapshot, request);
    return request.tip;
  };
  EXPECT_EQ(tip(""), std::nullopt);
  EXPECT_EQ(tip("arm/point"), std::nullopt);
  const std::optional<Vector3d> found = tip("arm/jaw");
  EXPECT_EQ(found, request.path[0].links[1].translation());
}
