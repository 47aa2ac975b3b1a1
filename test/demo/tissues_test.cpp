// The simulated tissues of the demo and of the example of finite elements, and the demo's tools.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "demo/liver.hpp"
#include "examples/fem_block.hpp"
#include "geometry/distance/closest_points.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using Vertices = std::vector<float>;

Vector3d vertex(const Vertices& all, std::size_t index) {
  return Vector3d(all[3 * index], all[3 * index + 1], all[3 * index + 2]);
}

std::uint32_t vertex_nearest(const Vertices& all, const Vector3d& place) {
  std::uint32_t nearest = 0;
  for (std::uint32_t i = 1; i < all.size() / 3; ++i) {
    if ((vertex(all, i) - place).norm() < (vertex(all, nearest) - place).norm()) nearest = i;
  }
  return nearest;
}

/// [m] The largest distance of a vertex from its position at rest; 1 m if it is not finite.
double farthest_from_rest(const Vertices& all, const Vertices& rest) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < all.size() / 3; ++i) {
    const double distance = (vertex(all, i) - vertex(rest, i)).norm();
    farthest = std::max(farthest, std::isfinite(distance) ? distance : 1.0);
  }
  return farthest;
}

/// Expects a closed surface that is oriented outwards. Returns its volume [m^3].
double expect_closed(const std::vector<FaceIndices>& faces, const Vertices& vertices) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0.0;
  for (const FaceIndices& face : faces) {
    for (int k = 0; k < 3; ++k) ++edges[{face[k], face[(k + 1) % 3]}];
    const Vector3d across = vertex(vertices, face[1]).cross(vertex(vertices, face[2]));
    volume += vertex(vertices, face[0]).dot(across) / 6.0;
  }
  for (const auto& [edge, uses] : edges) {
    EXPECT_EQ(uses, 1) << edge.first << " to " << edge.second;
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U) << edge.first << " to " << edge.second;
  }
  return volume;
}

class FemBlockTest : public testing::Test {
 protected:
  static constexpr double kStep = 0.004;  // [s]

  FemBlock block_;
  const Vertices rest_ = block_.vertices();
  const std::uint32_t top_ = vertex_nearest(rest_, Vector3d::Zero());
};

TEST_F(FemBlockTest, ItsSurfaceIsClosedAndOrientedOutwards) {
  EXPECT_NEAR(expect_closed(block_.faces(), rest_), 0.12 * 0.10 * 0.04, 1e-8);
}

TEST_F(FemBlockTest, ItYieldsToAForceAndComesBack) {
  for (int i = 0; i < 250; ++i) {
    block_.push(top_, {0.0, 0.0, -1.0}, kStep);
    block_.step(kStep);
  }
  const double still = vertex(block_.vertices(), top_).z();
  const double dent = vertex(rest_, top_).z() - still;
  EXPECT_GT(dent, 0.002);
  EXPECT_LT(dent, 0.02);
  block_.push(top_, {0.0, 0.0, -1.0}, kStep);
  block_.step(kStep);
  // At rest, the elements carry the force.
  EXPECT_NEAR(vertex(block_.vertices(), top_).z(), still, 1e-5);
  for (int i = 0; i < 500; ++i) block_.step(kStep);
  EXPECT_LT(farthest_from_rest(block_.vertices(), rest_), 2e-4);
}

class LiverTest : public testing::Test {
 protected:
  static constexpr double kStep = 0.008;  // [s] of the simulator
  static constexpr int kStepsPerBreath = 500;

  const ClosedSurface surface_ = make_liver_surface();
  LiverSoftBody liver_{surface_};
  const Vertices rest_ = liver_.vertices();
};

TEST_F(LiverTest, HasTheSizeOfALiverAndThePapersNumberOfFaces) {
  EXPECT_EQ(surface_.faces.size(), 1224U);
  EXPECT_EQ(surface_.vertices.size(), 614U);
  const double volume = expect_closed(surface_.faces, rest_);
  EXPECT_GT(volume, 5e-4);
  EXPECT_LT(volume, 1e-3);
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : surface_.vertices) {
    box.extend(vertex);
    EXPECT_NEAR(liver_level(vertex), 0.0, 2e-4);
  }
  EXPECT_NEAR(box.sizes().x(), 0.2, 0.02);
  EXPECT_LT(box.sizes().y(), box.sizes().x());
  EXPECT_LT(box.sizes().z(), box.sizes().y());
  for (std::size_t i = 0; i < surface_.faces.size(); ++i) {
    const Triangle t = surface_.triangle(i);
    const double area = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    // 1 for an equilateral triangle, 0 for a degenerate one.
    const double edges =
        (t[1] - t[0]).squaredNorm() + (t[2] - t[1]).squaredNorm() + (t[0] - t[2]).squaredNorm();
    EXPECT_GT(4.0 * std::sqrt(3.0) * area / edges, 0.45) << i;
    EXPECT_GT(area, 2e-6) << "[m^2] of face " << i;
    EXPECT_LT(area, 2e-4) << "[m^2] of face " << i;
  }
}

TEST_F(LiverTest, GivesWayInTheDirectionOfThePush) {
  for (const Vector3d& place : {Vector3d(-0.05, 0.0, 0.04), Vector3d(0.07, 0.02, 0.02),
                                Vector3d(-0.05, -0.06, 0.0), Vector3d(0.07, 0.02, -0.01)}) {
    LiverSoftBody unpushed(surface_), pushed(surface_);
    const std::uint32_t at = vertex_nearest(rest_, place);
    const Vector3d displacement(0.001, -0.002, place.z() > 0.01 ? -0.003 : 0.003);
    unpushed.step(kStep, {{7, Vector3d::Zero()}});  // It changes nothing.
    pushed.step(kStep, {{at, displacement}});
    const Vector3d moved = vertex(pushed.vertices(), at) - vertex(unpushed.vertices(), at);
    EXPECT_GT(moved.dot(displacement), 0.2 * displacement.squaredNorm()) << place.transpose();
    EXPECT_GT(moved.dot(displacement), 0.8 * moved.norm() * displacement.norm());
  }
}

TEST_F(LiverTest, ACutLeavesAClosedSurface) {
  const double whole = expect_closed(surface_.faces, rest_);
  for (const Vector3d& tilt : {Vector3d(0, 0, 0), Vector3d(0, 0.2, -0.1), Vector3d(0, -0.3, 0.2)}) {
    const Eigen::Hyperplane<double, 3> plane((Vector3d::UnitX() + tilt).normalized(),
                                             Vector3d(0.072, 0.017, 0.004));
    const CutSurface cut = cut_off(surface_, plane);
    ASSERT_EQ(cut.origins.size(), cut.surface.vertices.size());
    EXPECT_LT(cut.surface.faces.size(), surface_.faces.size());
    const Vertices left = LiverSoftBody(cut.surface).vertices();
    const double volume = expect_closed(cut.surface.faces, left);
    EXPECT_GT(volume, 0.8 * whole);
    EXPECT_LT(volume, 0.98 * whole);
    for (std::size_t i = 0; i < cut.origins.size(); ++i) {
      const Vector3d& place = cut.surface.vertices[i];
      const Vector3d& origin = surface_.vertices[cut.origins[i]];
      EXPECT_LE(plane.signedDistance(place), 1e-9);
      EXPECT_TRUE(place == origin || std::abs(plane.signedDistance(place)) < 1e-9) << i;
    }
    for (std::size_t i = 0; i < cut.surface.faces.size(); ++i) {
      const Triangle t = cut.surface.triangle(i);
      EXPECT_GT((t[1] - t[0]).cross(t[2] - t[0]).norm(), 0.0) << "face " << i;
    }
  }
}

/// [m] The distance from the axis to the liver at rest.
double distance_to(const ClosedSurface& liver, const ShaftAxis& axis) {
  double nearest = 1.0;
  for (std::size_t face = 0; face < liver.faces.size(); ++face) {
    nearest = std::min(nearest, closest_points(axis, liver.triangle(face)).distance);
  }
  return nearest;
}

TEST_F(LiverTest, TheStabberPassesThroughTheLobeWithinOneStepAndRestsOutside) {
  static_assert(kStabDuration <= kStep);
  EXPECT_GT(liver_level(kStabber.trocar), 0.03);
  constexpr double kBreath = 0.007;  // [m] motion of the liver by breathing
  for (int second = 0; second < 14; ++second) {
    for (double time = second + kStep; time < second + 1.0001; time += 0.031) {
      EXPECT_GT(distance_to(surface_, kStabber.at(time)), kToolRadius + kBreath)
          << "at " << time << " s a static test would find it";
    }
    const double halfway = second + 1.0 + 0.5 * kStabDuration;
    EXPECT_LT(distance_to(surface_, kStabber.at(halfway)), 1e-9) << "at " << halfway << " s";
    EXPECT_LT(liver_level(kStabber.tip(halfway)), 0.0) << "its tip is inside the lobe";
  }
}

}  // namespace
}  // namespace organ_collision
