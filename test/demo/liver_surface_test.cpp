#include "demo/liver_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
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

}  // namespace
}  // namespace organ_collision
