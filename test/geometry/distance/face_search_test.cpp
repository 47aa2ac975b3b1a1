#include "geometry/distance/face_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "geometry/distance/closest_points.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "test/grid_surface.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// A surface in the sender's order or in random order, in two shapes, and a box beside it.
struct Case {
  explicit Case(Random& random) {
    const Vector3d away =
        random.chance(0.3) ? random.point(random.scale(1.0, 1e4)) : Vector3d::Zero();
    GridSurface grid = grid_surface(random.integer(1, 30), random.uniform(0.0, 6.0));
    if (random.chance(0.5)) grid = shuffled(grid, static_cast<unsigned>(random.integer(0, 1000)));
    for (std::size_t i = 0; i < grid.vertices.size(); ++i) {
      grid.vertices[i] += static_cast<float>(away[static_cast<Eigen::Index>(i % 3)]);
    }
    const TriangleMesh first(grid.vertices, grid.triangles());
    before = after = std::make_unique<TriangleMesh>(first);
    if (random.chance(0.5)) {
      for (float& x : grid.vertices) x += static_cast<float>(random.uniform(-0.01, 0.01));
      after = std::make_unique<TriangleMesh>(first);
      after->move_vertices(grid.vertices);
    }
    const Eigen::Isometry3d pose = oracle::random_pose(0.15, random);
    box = {away + pose.translation(), pose.linear(),
           Vector3d(random.scale(1e-4, 0.2), random.scale(1e-4, 0.2), random.scale(1e-4, 0.2))};
    if (random.chance(0.3)) box.half_size.tail<2>().setZero();
  }

  OrganMotion organ() const {
    if (before == after) return OrganMotion(*after);
    return {*before, before->block_boxes(), *after, 0.0, 1.0};
  }
  /// [m] The smaller of the distances of a face from the box before and after the motion.
  double distance(std::size_t face) const {
    ConvexCore core;
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) {
          core.points[core.count++] =
              box.center + box.axes * box.half_size.cwiseProduct(Vector3d(x, y, z));
        }
      }
    }
    return std::min(closest_points(core, before->triangle(face)).distance,
                    closest_points(core, after->triangle(face)).distance);
  }

  std::shared_ptr<TriangleMesh> before, after;
  OrientedBox box;
};

TEST(FaceSearch, VisitsEveryFaceWithinTheBoundOnce) {
  Random random(1);
  FaceSearch search;
  std::size_t visited_count = 0, face_count = 0;
  for (int i = 0; i < 300; ++i) {
    const Case scene(random);
    const double bound = random.scale(1e-4, 0.3);
    std::multiset<std::uint32_t> visited;
    search.visit(
        scene.organ(), scene.box, [&] { return bound; },
        [&](std::uint32_t face) { visited.insert(face); });
    for (std::uint32_t face = 0; face < scene.after->face_count(); ++face) {
      EXPECT_LE(visited.count(face), 1U);
      if (scene.distance(face) <= bound) {
        EXPECT_EQ(visited.count(face), 1U) << face;
      }
    }
    visited_count += visited.size();
    face_count += scene.after->face_count();
  }
  EXPECT_LT(visited_count, face_count / 2);
}

TEST(FaceSearch, FindsTheNearestFaceWithAFallingBound) {
  Random random(2);
  FaceSearch search;
  std::size_t visited = 0, face_count = 0;
  for (int i = 0; i < 300; ++i) {
    const Case scene(random);
    double least = std::numeric_limits<double>::infinity();
    search.visit(
        scene.organ(), scene.box, [&] { return least; },
        [&](std::uint32_t face) {
          least = std::min(least, scene.distance(face));
          ++visited;
        });
    double expected = std::numeric_limits<double>::infinity();
    for (std::uint32_t face = 0; face < scene.after->face_count(); ++face) {
      expected = std::min(expected, scene.distance(face));
    }
    face_count += scene.after->face_count();
    EXPECT_EQ(least, expected);
  }
  EXPECT_LT(visited, face_count / 10);
}

}  // namespace
}  // namespace organ_collision
