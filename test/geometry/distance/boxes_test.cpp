// Boxes around what moves: which faces they rule out. The tests of viewing volumes prove that a
// swept box contains the box all the time, and is tight.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "geometry/distance/closest_points.hpp"
#include "geometry/distance/face_search.hpp"
#include "geometry/distance/first_touch.hpp"
#include "geometry/distance/separating_plane.hpp"
#include "geometry/distance/swept_box.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "test/grid_surface.hpp"
#include "test/proof/trial_suites.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

constexpr std::size_t kBox = 2;  // the number of this kind of core

/// The box with the core of a trial.
OrientedBox box_of(const ConvexCore& core) {
  const auto& p = core.points;
  OrientedBox box{0.5 * (p[0] + p[7]), {}, {}};
  const std::array<Vector3d, 3> edges = {p[4] - p[0], p[2] - p[0], p[1] - p[0]};
  for (int i = 0; i < 3; ++i) {
    box.half_size[i] = 0.5 * edges[i].norm();
    box.axes.col(i) = edges[i].normalized();
  }
  return box;
}

class SweptBoxTrials : public oracle::LinkTrials {};

TEST_P(SweptBoxTrials, WhatStaysClearStaysFartherThanTheRadius) {
  int clear = 0;
  for_each_trial(2000, [&](const LinkTrial& trial, Random& random) {
    FaceMotion face{trial.face, trial.face};
    const double away = random.scale(1e-4, 0.3);
    const Vector3d by = away * random.direction();
    for (int i = 0; i < 3; ++i) {
      face.start[i] += by;
      face.end[i] = face.start[i];
      if (random.chance(0.5)) face.end[i] += random.scale(1e-5, 0.1) * random.direction();
    }
    const RigidMotion motion = trial.motion();
    const double until =
        SweptBox(box_of(trial.core), motion, trial.radius).clear_until(LegFace(face));
    if (until == 0.0) return;
    ++clear;
    for (int i = 0; i < 100; ++i) {
      // At `until` itself the distance may equal the radius, except for rounding.
      const double time = std::min(until, 1.0) * (i < 2 ? i : random.uniform(0.0, 1.0));
      EXPECT_GT(closest_points(motion.at(time) * trial.core, face.at(time)).distance,
                trial.radius - oracle::rounding(trial))
          << "at " << time;
    }
  });
  EXPECT_GT(clear, 200);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, SweptBoxTrials,
    testing::Combine(testing::Range<std::size_t>(0, oracle::link_trial_kinds().size()),
                     testing::Values(kBox)));

/// A surface in the sender's order or in random order, in two shapes, and a box beside it.
struct SearchScene {
  explicit SearchScene(Random& random) {
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
    const Vector3d size(random.scale(2e-4, 0.4), random.scale(2e-4, 0.4), random.scale(2e-4, 0.4));
    LinkPart part = LinkPart::box(oracle::random_pose(0.15, random), size);
    for (Vector3d& corner : part.core.points) corner += away;
    core = part.core;
    box = part.bounds;
    box.center += away;
  }

  OrganMotion organ() const {
    if (before == after) return OrganMotion(*after);
    return {*before, before->block_boxes(), *after, 0.0, 1.0};
  }
  /// [m] The smaller of the distances of a face from the box before and after the motion.
  double distance(std::size_t face) const {
    return std::min(closest_points(core, before->triangle(face)).distance,
                    closest_points(core, after->triangle(face)).distance);
  }

  std::shared_ptr<TriangleMesh> before, after;
  ConvexCore core;
  OrientedBox box;
};

// The bound is constant, or the smallest distance so far.
TEST(FaceSearch, VisitsEveryFaceWithinTheBoundOnceAndFewOthers) {
  Random random(1);
  FaceSearch search;
  std::size_t within = 0, nearer = 0, all = 0;
  for (int i = 0; i < 300; ++i) {
    const SearchScene scene(random);
    const double bound = random.scale(1e-4, 0.3);
    std::multiset<std::uint32_t> visited;
    search.visit(
        scene.organ(), scene.box, [&] { return bound; },
        [&](std::uint32_t face) {
          visited.insert(face);
          return true;
        });
    double found = std::numeric_limits<double>::infinity(), least = found;
    search.visit(
        scene.organ(), scene.box, [&] { return found; },
        [&](std::uint32_t face) {
          found = std::min(found, scene.distance(face));
          ++nearer;
          return true;
        });
    std::multiset<std::uint32_t> first;
    const auto most = static_cast<std::size_t>(random.integer(1, 200));
    const std::size_t left = search.visit(
        scene.organ(), scene.box, [&] { return bound; },
        [&](std::uint32_t face) {
          if (first.size() == most) return false;
          first.insert(face);
          return true;
        });
    EXPECT_EQ(first.size(), std::min(most, visited.size()));
    EXPECT_GE(first.size() + left, visited.size());
    EXPECT_LE(first.size() + left, scene.after->face_count());
    EXPECT_TRUE(visited.size() > most || left == 0U);
    for (std::uint32_t face = 0; face < scene.after->face_count(); ++face) {
      const double distance = scene.distance(face);
      least = std::min(least, distance);
      EXPECT_LE(visited.count(face), 1U);
      if (distance <= bound) {
        EXPECT_EQ(visited.count(face), 1U) << face;
      }
    }
    EXPECT_EQ(found, least);
    within += visited.size();
    all += scene.after->face_count();
  }
  EXPECT_LT(within, all / 2);
  EXPECT_LT(nearer, all / 10);
}

}  // namespace
}  // namespace organ_collision
