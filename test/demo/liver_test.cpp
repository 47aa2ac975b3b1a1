#include "demo/liver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

const ClosedSurface& liver() {
  static const ClosedSurface surface = make_liver_surface();
  return surface;
}

Vector3d area_vector(const Triangle& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]); }

/// 1 for an equilateral triangle, 0 for a degenerate one.
double quality(const Triangle& t) {
  const double edges =
      (t[1] - t[0]).squaredNorm() + (t[2] - t[1]).squaredNorm() + (t[0] - t[2]).squaredNorm();
  return 4.0 * std::sqrt(3.0) * area_vector(t).norm() / edges;
}

/// Whether the segment meets the triangle: its ends are on different sides of the plane, and the
/// line passes all three edges on the same side.
bool crosses(const Vector3d& from, const Vector3d& to, const Triangle& t) {
  const Vector3d normal = area_vector(t);
  if (normal.dot(from - t[0]) * normal.dot(to - t[0]) > 0.0) return false;
  const Vector3d way = to - from;
  const double a = way.dot((t[0] - from).cross(t[1] - from));
  const double b = way.dot((t[1] - from).cross(t[2] - from));
  const double c = way.dot((t[2] - from).cross(t[0] - from));
  return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
}

bool share_a_vertex(const FaceIndices& a, const FaceIndices& b) {
  for (const std::uint32_t i : a) {
    for (const std::uint32_t j : b) {
      if (i == j) return true;
    }
  }
  return false;
}

TEST(LiverSurface, HasThePapersNumberOfFaces) {
  EXPECT_EQ(liver().faces.size(), 1224U);
  EXPECT_EQ(liver().vertices.size(), 614U);
}

TEST(LiverSurface, IsAClosedManifold) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const FaceIndices& face : liver().faces) {
    for (int k = 0; k < 3; ++k) ++edges[{face[k], face[(k + 1) % 3]}];
  }
  for (const auto& [edge, uses] : edges) {
    EXPECT_EQ(uses, 1) << edge.first << " to " << edge.second;
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U) << edge.first << " to " << edge.second;
  }
  const int euler_characteristic = static_cast<int>(liver().vertices.size()) -
                                   static_cast<int>(edges.size() / 2) +
                                   static_cast<int>(liver().faces.size());
  EXPECT_EQ(euler_characteristic, 2);
}

TEST(LiverSurface, IsOneLiverLarge) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : liver().vertices) box.extend(vertex);
  EXPECT_NEAR(box.sizes().x(), 0.2, 0.02);
  EXPECT_LT(box.sizes().y(), box.sizes().x());
  EXPECT_LT(box.sizes().z(), box.sizes().y());
}

TEST(LiverSurface, FacesOutward) {
  double volume = 0.0;
  for (std::size_t i = 0; i < liver().faces.size(); ++i) {
    const Triangle t = liver().triangle(i);
    const Vector3d centre = (t[0] + t[1] + t[2]) / 3.0;
    const Vector3d outward = area_vector(t).normalized();
    EXPECT_GT(liver_level(centre + 0.004 * outward), liver_level(centre - 0.004 * outward)) << i;
    volume += area_vector(t).dot(t[0]) / 3.0;
  }
  EXPECT_GT(volume, 5e-4);
  EXPECT_LT(volume, 1e-3);
}

TEST(LiverSurface, LiesOnItsLevel) {
  for (const Vector3d& vertex : liver().vertices) EXPECT_NEAR(liver_level(vertex), 0.0, 2e-4);
}

TEST(LiverSurface, IsNotConvex) {
  // For the fissure and for the hollow underneath: a chord between two points of the surface runs a
  // centimetre outside of the liver.
  const auto middle_is_outside = [](const Vector3d& a, const Vector3d& b) {
    EXPECT_LE(liver_level(a), 0.0);
    EXPECT_LE(liver_level(b), 0.0);
    return liver_level(0.5 * (a + b));
  };
  EXPECT_GT(middle_is_outside({-0.015, -0.045, 0.0}, {0.055, -0.008, 0.006}), 0.008);
  EXPECT_GT(middle_is_outside({-0.055, -0.010, -0.028}, {0.045, 0.0, -0.006}), 0.003);
}

TEST(LiverSurface, HasNoSliverTriangles) {
  for (std::size_t i = 0; i < liver().faces.size(); ++i) {
    EXPECT_GT(quality(liver().triangle(i)), 0.45) << i;
    EXPECT_GT(area_vector(liver().triangle(i)).norm(), 2e-6) << "[m^2] of face " << i;
    EXPECT_LT(area_vector(liver().triangle(i)).norm(), 2e-4) << "[m^2] of face " << i;
  }
}

TEST(LiverSurface, DoesNotMeetItself) {
  const ClosedSurface& s = liver();
  for (std::size_t i = 0; i < s.faces.size(); ++i) {
    const Triangle face = s.triangle(i);
    for (std::size_t j = 0; j < s.faces.size(); ++j) {
      if (share_a_vertex(s.faces[i], s.faces[j])) continue;
      for (int k = 0; k < 3; ++k) {
        EXPECT_FALSE(crosses(face[k], face[(k + 1) % 3], s.triangle(j))) << i << " and " << j;
      }
    }
  }
}

constexpr double kStep = 0.008;        // [s]
constexpr double kBreathPeriod = 4.0;  // [s]
const int kStepsPerBreath = static_cast<int>(std::lround(kBreathPeriod / kStep));

class LiverSoftBodyTest : public testing::Test {
 protected:
  Vector3d vertex(std::size_t index) const {
    const std::vector<float> all = liver_.vertices();
    return Vector3d(all[3 * index], all[3 * index + 1], all[3 * index + 2]);
  }

  Vector3d centre(std::uint32_t face) const {
    const FaceIndices& f = surface_.faces[face];
    return (vertex(f[0]) + vertex(f[1]) + vertex(f[2])) / 3.0;
  }

  /// [m] The largest distance of a vertex from its position at rest; 1 m if it is not finite.
  double farthest_from_rest() const {
    const std::vector<float> all = liver_.vertices();
    double farthest = 0.0;
    for (std::size_t i = 0; i < surface_.vertices.size(); ++i) {
      const Vector3d now(all[3 * i], all[3 * i + 1], all[3 * i + 2]);
      const double distance = (now - surface_.vertices[i]).norm();
      farthest = std::max(farthest, std::isfinite(distance) ? distance : 1.0);
    }
    return farthest;
  }

  std::uint32_t face_nearest(const Vector3d& place) const {
    std::uint32_t nearest = 0;
    for (std::uint32_t face = 1; face < surface_.faces.size(); ++face) {
      if ((centre(face) - place).norm() < (centre(nearest) - place).norm()) nearest = face;
    }
    return nearest;
  }

  static TissuePush push(std::uint32_t face, const Vector3d& displacement) {
    return {face, Vector3d::Constant(1.0 / 3.0), displacement};
  }

  ClosedSurface surface_ = make_liver_surface();
  LiverSoftBody liver_{surface_};
};

TEST_F(LiverSoftBodyTest, StartsAtRest) {
  EXPECT_EQ(liver_.vertices().size(), 3 * surface_.vertices.size());
  EXPECT_LT(farthest_from_rest(), 1e-7);
}

TEST_F(LiverSoftBodyTest, BreathesForMinutesAndStaysInShape) {
  double farthest = 0.0;
  for (int step = 1; step <= 30 * kStepsPerBreath; ++step) {  // two minutes
    liver_.step(kStep, {});
    farthest = std::max(farthest, farthest_from_rest());
    if (step % kStepsPerBreath == 0) {
      ASSERT_LT(farthest_from_rest(), 5e-4) << "after " << step * kStep << " s";
    }
  }
  EXPECT_GT(farthest, 0.005);
  EXPECT_LT(farthest, 0.009);
}

TEST_F(LiverSoftBodyTest, GivesWayInTheDirectionOfThePush) {
  for (const Vector3d& place : {Vector3d(-0.05, 0.0, 0.04), Vector3d(0.07, 0.02, 0.02),
                                Vector3d(-0.05, -0.06, 0.0), Vector3d(0.07, 0.02, -0.01)}) {
    LiverSoftBody unpushed(surface_), pushed(surface_);
    const std::uint32_t face = face_nearest(place);
    const Vector3d displacement(0.001, -0.002, place.z() > 0.01 ? -0.003 : 0.003);
    unpushed.step(kStep, {});
    pushed.step(kStep, {push(face, displacement)});
    const std::vector<float> before = unpushed.vertices(), after = pushed.vertices();
    Vector3d moved = Vector3d::Zero();
    for (const std::uint32_t index : surface_.faces[face]) {
      for (int axis = 0; axis < 3; ++axis) {
        moved[axis] += (after[3 * index + axis] - before[3 * index + axis]) / 3.0;
      }
    }
    EXPECT_GT(moved.dot(displacement), 0.2 * displacement.squaredNorm()) << place.transpose();
    EXPECT_GT(moved.dot(displacement), 0.8 * moved.norm() * displacement.norm());
  }
}

TEST_F(LiverSoftBodyTest, AVertexThatIsPushedGivesWay) {
  const std::uint32_t vertex_pushed = surface_.faces[face_nearest({-0.05, 0.0, 0.04})][0];
  LiverSoftBody unpushed(surface_);
  const Vector3d displacement(0.001, -0.002, -0.003);
  unpushed.step(kStep, {});
  liver_.step(kStep, {}, {{vertex_pushed, displacement}});
  const std::vector<float> before = unpushed.vertices();
  const Vector3d moved =
      vertex(vertex_pushed) -
      Eigen::Map<const Eigen::Vector3f>(&before[3 * vertex_pushed]).cast<double>();
  EXPECT_GT(moved.dot(displacement), 0.2 * displacement.squaredNorm());
  EXPECT_GT(moved.dot(displacement), 0.8 * moved.norm() * displacement.norm());
}

TEST_F(LiverSoftBodyTest, APushWithoutWayChangesNothing) {
  LiverSoftBody unpushed(surface_);
  unpushed.step(kStep, {});
  liver_.step(kStep, {}, {{7, Vector3d::Zero()}});
  EXPECT_EQ(liver_.vertices(), unpushed.vertices());
}

TEST_F(LiverSoftBodyTest, ReturnsWhenLetGo) {
  const std::uint32_t face = face_nearest({-0.05, 0.0, 0.04});
  for (int step = 0; step < 25; ++step) liver_.step(kStep, {push(face, {0.0, 0.0, -0.001})});
  EXPECT_GT(farthest_from_rest(), 0.004);
  for (int step = 25; step < kStepsPerBreath; ++step) liver_.step(kStep, {});
  EXPECT_LT(farthest_from_rest(), 5e-4);
}

TEST_F(LiverSoftBodyTest, SurvivesViolence) {
  // Pushes all faces at once, back and forth, as far as the simulator ever does.
  for (int step = 0; step < 500; ++step) {
    std::vector<TissuePush> pushes;
    for (std::uint32_t face = 0; face < surface_.faces.size(); ++face) {
      const double side = (face + step) % 3 == 0 ? 0.008 : -0.008;
      pushes.push_back({face, Vector3d(0.98, 0.02, 0.0), Vector3d(side, -side, side)});
    }
    liver_.step(kStep, pushes);
    ASSERT_LT(farthest_from_rest(), 0.1) << "step " << step;
  }
  for (int step = 500; step < 1000; ++step) liver_.step(kStep, {});
  EXPECT_LT(farthest_from_rest(), 0.01);
}

TEST_F(LiverSoftBodyTest, HardlyDependsOnTheStep) {
  LiverSoftBody finer(surface_);
  for (int i = 0; i < 100; ++i) liver_.step(0.01, {});
  for (int i = 0; i < 200; ++i) finer.step(0.005, {});
  const std::vector<float> a = liver_.vertices(), b = finer.vertices();
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 5e-4);
}

}  // namespace

}  // namespace organ_collision
