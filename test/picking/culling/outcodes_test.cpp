// Outcodes reject what they can. The proofs show that they reject nothing that touches.
#include "picking/culling/outcodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "picking/volumes/viewing_volume.hpp"
#include "test/grid_surface.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// A box with random axes, and up to eight planes through it.
ViewingVolume random_volume(Random& random, const Vector3d& origin, std::size_t planes) {
  const Eigen::Matrix3d axes = camera_axes(random.point(1.0), random.point(1.0));
  const double size = random.scale(3e-4, 3.0);
  ViewingVolume volume =
      ViewingVolume::orthographic({origin + random.point(0.2), Vector3d::Zero(), axes, -size, size,
                                   -size, size, -size, 4 * size});
  for (std::size_t i = 0; i < planes; ++i) {
    volume.add_user_plane({random.direction(), size * random.uniform(-1.0, 1.0)});
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

/// [m] The same for the corner that is least outside. Negative: it is inside the volume.
double least_corner(const Triangle& face, const ViewingVolume& volume) {
  double least = 1e9;
  for (const Vector3d& corner : face) {
    least = std::min(least, farthest_outside({corner, corner, corner}, volume));
  }
  return least;
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
  Random random(17);
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
  Random random(19);
  Outcodes outcodes;
  const GridSurface grid = grid_surface(5);
  const TriangleMesh mesh(grid.vertices, grid.triangles());
  std::size_t inside = 0, crossing = 0;
  for (std::size_t trial = 0; trial < 2160; ++trial) {
    const ViewingVolume volume = random_volume(random, Vector3d::Zero(), trial % 9);
    outcodes.assign(volume, OrganMotion(mesh));
    for (const std::uint32_t i : kept(outcodes)) {
      const double least = least_corner(mesh.triangle(i), volume);
      if (std::abs(least) < 4e-6) continue;
      ASSERT_EQ(outcodes.has_corner_inside(mesh.faces()[i]), least < 0.0);
      ++(least < 0.0 ? inside : crossing);
    }
  }
  EXPECT_GT(inside, 1000U);
  EXPECT_GT(crossing, 100U);
}

}  // namespace
}  // namespace organ_collision
