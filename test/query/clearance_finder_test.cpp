#include "query/clearance_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "approach_scenes.hpp"
#include "test/grid_surface.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

CollisionResult answer(const CollisionRequest& request) {
  static CollisionQuery query;
  CollisionResult result;
  query.evaluate(request, result);
  EXPECT_EQ(result.unresolved, 0U);
  return result;
}

void move_by(const Vector3d& offset, ToolWaypoint& waypoint) {
  waypoint.axis.trocar += offset;
  waypoint.axis.tip += offset;
  for (Eigen::Isometry3d& pose : waypoint.links) pose.translation() += offset;
}

/// The parts of a clearance fit together, and to the request.
void expect_consistent(const ToolClearance& clearance, const CollisionRequest& request) {
  EXPECT_TRUE(clearance.is_resolved);
  ASSERT_EQ(clearance.state, ClearanceState::kKnown);
  EXPECT_NEAR(clearance.normal.norm(), 1.0, 1e-12);
  EXPECT_LE((clearance.on_organ - clearance.on_tool - clearance.distance * clearance.normal).norm(),
            1e-15);
  EXPECT_EQ(clearance.vertices, request.organ->faces()[clearance.face]);
  EXPECT_NEAR(clearance.barycentric.sum(), 1.0, 1e-12);
  EXPECT_GE(clearance.barycentric.minCoeff(), 0.0);
  EXPECT_LE((point_at(request.organ->triangle(clearance.face), clearance.barycentric) -
             clearance.on_organ)
                .norm(),
            1e-12);
  EXPECT_LE(clearance.least, std::max(clearance.distance, 0.0));
  EXPECT_GE(clearance.least_fraction, 0.0);
  EXPECT_LE(clearance.least_fraction, 1.0);
}

TEST(ClearanceFinder, AtRestIsTheLeastDistanceOfAllFaces) {
  Random random(1);
  for (int i = 0; i < 400; ++i) {
    LinkScene scene(true, random);
    scene.request.mode = QueryMode::kStatic;
    scene.request.clearance = true;
    const CollisionResult result = answer(scene.request);
    const ToolClearance& clearance = result.clearance;
    expect_consistent(clearance, scene.request);
    EXPECT_TRUE(clearance.unlimited);
    EXPECT_EQ(clearance.margin, 0.0);
    const auto nearest = MeasuredApproaches(scene.request, true).nearest();
    EXPECT_NEAR(clearance.distance, nearest.distance, kExact);
    EXPECT_EQ(clearance.least, clearance.distance);
    EXPECT_EQ(clearance.least_fraction, 0.0);
  }
}

TEST(ClearanceFinder, OfAStepIsTheLeastDistanceAtAnyTime) {
  Random random(2);
  int apart = 0;
  for (int i = 0; i < 300; ++i) {
    LinkScene scene(true, random);
    scene.request.clearance = true;
    if (random.chance(0.3)) scene.request.path.resize(1);
    if (random.chance(0.6)) {  // Away from the organ, so that nothing is touched.
      const Vector3d away = 0.4 * random.direction();
      for (ToolWaypoint& waypoint : scene.request.path) move_by(away, waypoint);
    }
    const CollisionResult result = answer(scene.request);
    expect_consistent(result.clearance, scene.request);
    EXPECT_NEAR(result.clearance.distance,
                MeasuredApproaches(scene.request, true).nearest().distance, kExact);
    if (!result.contacts.empty()) {
      double first = 1.0;
      for (const FaceContact& contact : result.contacts) first = std::min(first, contact.fraction);
      EXPECT_EQ(result.clearance.least, 0.0);
      EXPECT_EQ(result.clearance.least_fraction, first);
      continue;
    }
    ++apart;
    EXPECT_NEAR(result.clearance.least, MeasuredApproaches(scene.request, false).nearest().distance,
                kMoving);
  }
  EXPECT_GT(apart, 100);
}

TEST(ClearanceFinder, IsKnownUpToTheMargin) {
  Random random(3);
  int beyond = 0;
  for (int i = 0; i < 300; ++i) {
    LinkScene scene(true, random);
    const Vector3d away = random.uniform(0.0, 0.4) * random.direction();
    for (ToolWaypoint& waypoint : scene.request.path) move_by(away, waypoint);
    if (random.chance(0.5)) scene.request.mode = QueryMode::kStatic;
    const double distance = MeasuredApproaches(scene.request, true).nearest().distance;
    scene.request.margin =
        distance > 0.0 ? distance * random.uniform(0.2, 3.0) : random.scale(1e-4, 1.0);
    const ToolClearance clearance = answer(scene.request).clearance;
    EXPECT_EQ(clearance.margin, scene.request.margin);
    EXPECT_FALSE(clearance.unlimited);
    if (distance <= scene.request.margin) {
      expect_consistent(clearance, scene.request);
      EXPECT_NEAR(clearance.distance, distance, kExact);
    } else {
      ++beyond;
      EXPECT_EQ(clearance.state, ClearanceState::kBeyondMargin);
      EXPECT_EQ(clearance.distance, 0.0);
      EXPECT_EQ(clearance.least, 0.0);
    }
  }
  EXPECT_GT(beyond, 30);
}

TEST(ClearanceFinder, OfAShaftIsPositiveExactlyIfNothingIsTouched) {
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    const Soup soup = scattered_faces(60, random);
    const TriangleMesh organ = mesh(soup);
    CollisionRequest request = swept(organ, random_path(true, random), random.scale(1e-3, 0.02));
    request.mode = QueryMode::kStatic;
    request.clearance = true;
    const CollisionResult result = answer(request);
    EXPECT_EQ(result.clearance.distance <= 0.0, !result.contacts.empty());
    EXPECT_GE(result.clearance.distance, -request.radius - 1e-12);
  }
}

TEST(ClearanceFinder, NormalIsTheFacesOwnIfTheAxisPiercesIt) {
  const TriangleMesh organ({-0.05F, -0.05F, 0.1F, 0.05F, -0.05F, 0.1F, 0.0F, 0.05F, 0.1F},
                           {0, 1, 2});
  CollisionRequest request =
      swept(organ, {{0.0, {{0.003, 0.002, 0.3}, {0.001, -0.004, 0.02}}}}, 0.005);
  request.mode = QueryMode::kStatic;
  request.clearance = true;
  const ToolClearance clearance = answer(request).clearance;
  EXPECT_FALSE(clearance.normal_defined);
  EXPECT_LE((clearance.normal - Vector3d(0.0, 0.0, -1.0)).norm(), 1e-6);
  EXPECT_NEAR(clearance.distance, -request.radius, 1e-12);

  request.path[0].axis.tip.z() = 0.11;
  const ToolClearance above = answer(request).clearance;
  EXPECT_TRUE(above.normal_defined);
  EXPECT_NEAR(above.distance, 0.01 - request.radius, 1e-8);
  EXPECT_LE((above.on_organ - Vector3d(0.001, -0.004, 0.1)).norm(), 1e-8);
  EXPECT_LE((above.on_tool - Vector3d(0.001, -0.004, 0.105)).norm(), 1e-8);
}

TEST(ClearanceFinder, IsFarBeyondTheOrgansSize) {
  Random random(5);
  const TriangleMesh organ = mesh(liver());
  for (const double away : {1.0, 30.0, 1e3, 1e5}) {
    const Vector3d offset = away * random.direction();
    const ShaftAxis axis{offset + random.point(0.1), offset + random.point(0.1)};
    CollisionRequest request = swept(organ, {{0.0, axis}}, 0.004);
    request.mode = QueryMode::kStatic;
    request.margin = 2.0 * away;
    const ToolClearance clearance = answer(request).clearance;
    expect_consistent(clearance, request);
    EXPECT_NEAR(clearance.distance, MeasuredApproaches(request, true).nearest().distance,
                kExact + 1e-14 * away);
  }
}

TEST(ClearanceFinder, DoesNotDependOnTheOrderOfFacesAndVertices) {
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    const GridSurface grid = grid_surface(20, random.uniform(0.0, 6.0));
    const GridSurface other = shuffled(grid, static_cast<unsigned>(i));
    const TriangleMesh organ(grid.vertices, grid.triangles());
    const TriangleMesh reordered(other.vertices, other.triangles());
    CollisionRequest request = swept(organ, random_path(true, random), 0.003);
    request.clearance = true;
    const ToolClearance expected = answer(request).clearance;
    request.organ = &reordered;
    const ToolClearance clearance = answer(request).clearance;
    EXPECT_NEAR(clearance.distance, expected.distance, 1e-12);
    EXPECT_NEAR(clearance.least, expected.least, kMoving);
  }
}

TEST(ClearanceFinder, IsNotAskedForByDefault) {
  Random random(7);
  const LinkScene scene(true, random);
  EXPECT_EQ(answer(scene.request).clearance.state, ClearanceState::kNotAsked);
}

}  // namespace
}  // namespace organ_collision
