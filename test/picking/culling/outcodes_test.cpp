#include "picking/culling/outcodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "picking/volumes/viewing_volume.hpp"
#include "test/grid_surface.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// A box with random axes, and up to eight planes through it.
ViewingVolume random_volume(std::mt19937& random, const Vector3d& origin, std::size_t planes) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vector3d(uniform(random), uniform(random), uniform(random)); };
  const Eigen::Matrix3d axes = camera_axes(vector(), vector());
  const double size = std::pow(10.0, 2.0 * uniform(random) - 1.5);
  ViewingVolume volume = ViewingVolume::orthographic(
      {origin + 0.2 * vector(), Vector3d::Zero(), axes, -size, size, -size, size, -size, 4 * size});
  for (std::size_t i = 0; i < planes; ++i) {
    volume.add_user_plane({vector().normalized(), size * uniform(random)});
  }
  return volume;
}

/// [m] The largest distance by which all corners of the face are outside one half-space. If it is
/// not positive, no half-space rejects the face.
double farthest_outside(const Triangle& face, const ViewingVolume& volume) {
  double farthest = -1e9;
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    const HalfSpace h = volume.half_space(i);
    double nearest = 1e9;
    for (const Vector3d& corner : face) {
      nearest = std::min(nearest, h.normal.dot(corner - volume.origin()) - h.offset);
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

/// The faces that outcodes do not reject.
std::set<std::uint32_t> kept(Outcodes& outcodes) {
  std::set<std::uint32_t> faces;
  outcodes.for_each_face([&](const FaceClusters::Face& face) {
    EXPECT_TRUE(faces.insert(face.number).second) << "visited twice";
  });
  return faces;
}

TEST(Outcodes, RejectTheFacesOutsideOneHalfSpace) {
  std::mt19937 random(17);
  Outcodes outcodes;
  for (const float far : {0.0F, 2.5F, 1000.0F}) {
    for (const bool shuffle : {false, true}) {
      // With 150 cells along a side there are two levels of groups.
      const int side = far == 0.0F ? 150 : 33;
      GridSurface grid = shuffle ? shuffled(grid_surface(side), 2) : grid_surface(side);
      for (float& x : grid.vertices) x += far;
      const TriangleMesh mesh(grid.vertices, grid.triangles());
      const double slack = 4e-6 * (1.0 + far);
      std::size_t rejected = 0;
      for (std::size_t trial = 0; trial < 54; ++trial) {
        const ViewingVolume volume = random_volume(random, Vector3d::Constant(far), trial % 9);
        outcodes.assign(volume, OrganMotion(mesh));
        const std::set<std::uint32_t> faces = kept(outcodes);
        for (std::uint32_t i = 0; i < mesh.face_count(); ++i) {
          const double outside = farthest_outside(mesh.triangle(i), volume);
          if (outside > slack) {
            ASSERT_EQ(faces.count(i), 0U) << outside;
          }
          if (outside <= 0.0) {
            ASSERT_EQ(faces.count(i), 1U) << outside;
          }
          rejected += outside > slack;
        }
      }
      EXPECT_GT(rejected, 10 * mesh.face_count());
      EXPECT_LT(rejected, 53 * mesh.face_count());
    }
  }
}

TEST(Outcodes, KnowFacesWithACornerInside) {
  std::mt19937 random(19);
  Outcodes outcodes;
  const GridSurface grid = grid_surface(5);
  const TriangleMesh mesh(grid.vertices, grid.triangles());
  const auto farthest_corner = [](const Triangle& face, const ViewingVolume& volume) {
    double least = 1e9;
    for (const Vector3d& corner : face) {
      least = std::min(least, farthest_outside({corner, corner, corner}, volume));
    }
    return least;
  };
  std::size_t inside = 0, crossing = 0;
  for (std::size_t trial = 0; trial < 1080; ++trial) {
    const ViewingVolume volume = random_volume(random, Vector3d::Zero(), trial % 9);
    outcodes.assign(volume, OrganMotion(mesh));
    for (const std::uint32_t i : kept(outcodes)) {
      const double outside = farthest_corner(mesh.triangle(i), volume);
      if (std::abs(outside) < 4e-6) continue;
      EXPECT_EQ(outcodes.has_corner_inside(mesh.faces()[i]), outside < 0.0);
      ++(outside < 0.0 ? inside : crossing);
    }
  }
  EXPECT_GT(inside, 1000U);
  EXPECT_GT(crossing, 100U);
}

TEST(Outcodes, NeverRejectAFaceThatTouchesTheVolumeInOnePoint) {
  std::mt19937 random(18);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Outcodes outcodes;
  for (int trial = 0; trial < 2000; ++trial) {
    // The face's first corner is as near to the boundary of a half-space as floats allow.
    const double far = std::pow(10.0, trial % 6 - 3);
    const ViewingVolume volume = random_volume(random, Vector3d::Constant(far), 3);
    const HalfSpace h = volume.half_space(static_cast<std::size_t>(trial) % 9);
    const Vector3d point = volume.origin() + h.normal * h.offset;
    const Vector3d aside(uniform(random), uniform(random), uniform(random));
    const Vector3d up = aside.dot(h.normal) > 0.0 ? aside : Vector3d(-aside);
    std::vector<float> vertices;
    for (const Vector3d& corner : {point, Vector3d(point + up), Vector3d(point + 2.0 * up)}) {
      for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(corner[k]));
    }
    const TriangleMesh mesh(vertices, {0, 1, 2});
    outcodes.assign(volume, OrganMotion(mesh));
    const std::set<std::uint32_t> faces = kept(outcodes);
    if (farthest_outside(mesh.triangle(0), volume) <= 0.0) {
      EXPECT_EQ(faces.count(0), 1U);
    }
  }
}

}  // namespace
}  // namespace organ_collision
