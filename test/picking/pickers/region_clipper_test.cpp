#include "picking/pickers/region_clipper.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "picking/volumes/conservative_volume.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "test/picking/volumes/clip_oracle.hpp"
#include "test/picking/volumes/random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d area(const Polygon& polygon) {
  Vector3d twice = Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return twice / 2;
}

// [m] The largest distance from a corner of `from` to the nearest corner of `to`.
double farthest_corner(const Polygon& from, const Polygon& to) {
  double farthest = 0;
  for (const Vector3d& corner : from) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3d& other : to) nearest = std::min(nearest, (corner - other).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

TEST(RegionClipper, RegionsAreTheClippedFaces) {
  GlContext context;
  RegionClipper clipper(context);
  Random random(41);
  int compared = 0, empty = 0;
  for (int i = 0; i < 600; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const double offset = i % 2 == 0 ? 0.3 : 200;
    const ShaftMotion motion = random_motion(kind, offset, random);
    const ViewingVolume volume = conservative_volume(motion, 0.005, {});
    std::vector<float> vertices;
    std::vector<std::uint32_t> triangles, faces;
    for (std::uint32_t k = 0; k < 90; ++k) {
      if (k % 3 == 0) faces.insert(faces.begin(), k / 3);
      const Vector3d centre =
          motion.at(random.uniform(0, 1)).at(random.uniform(0, 1)) + 0.01 * random.direction();
      const Vector3d corner = centre + random.uniform(0.001, 0.05) * random.direction();
      for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(corner[k]));
      triangles.push_back(k);
    }
    const TriangleMesh mesh(vertices, triangles);
    const std::vector<Region> regions = clipper.clip(volume, mesh, faces);
    ASSERT_EQ(regions.size(), faces.size());
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const Triangle face = mesh.triangle(faces[k]);
      switch (verdict(volume, face, 1e-5)) {
        case Verdict::kOut:
          EXPECT_TRUE(regions[k].empty()) << motion;
          ++empty;
          break;
        case Verdict::kIn: {
          Polygon expected = clip_oracle(volume, face);
          for (Vector3d& corner : expected) corner += volume.origin();
          const Vector3d normal = (face[1] - face[0]).cross(face[2] - face[0]);
          // If a plane meets the face at a small angle, the corners are ill-conditioned, but the
          // area is not.
          const double size = std::sqrt(normal.norm());
          EXPECT_NEAR((area(regions[k]) - area(expected)).norm(), 0, 1e-5 * size) << motion;
          EXPECT_GT(area(regions[k]).dot(normal), 0) << "the face's turning direction" << motion;
          for (const Vector3d& corner : regions[k]) {
            EXPECT_NEAR(normal.normalized().dot(corner - face[0]), 0, 1e-9);
            for (std::size_t plane = 0; plane < volume.half_space_count(); ++plane) {
              const HalfSpace half_space = volume.half_space(plane);
              EXPECT_LE(half_space.normal.dot(corner - volume.origin()), half_space.offset + 5e-6);
            }
          }
          EXPECT_LT(farthest_corner(expected, regions[k]), 1e-3) << motion;
          ++compared;
          break;
        }
        case Verdict::kClose:
          break;
      }
    }
  }
  EXPECT_GT(compared, 3000);
  EXPECT_GT(empty, 500);
}

TEST(RegionClipper, AFaceInsideIsItsOwnRegion) {
  GlContext context;
  const ShaftAxis axis{Vector3d(1, 2, 3), Vector3d(1, 2, 3.2)};
  const TriangleMesh mesh({1, 2, 3.125F, 1.001F, 2, 3.125F, 1, 2.001F, 3.126F}, {0, 1, 2, 2, 1, 0});
  const std::vector<Region> regions =
      RegionClipper(context).clip(conservative_volume({axis, axis}, 0.005, {}), mesh, {1, 0});
  ASSERT_EQ(regions.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(regions[i].size(), 3u);
    const Triangle face = mesh.triangle(1 - i);
    EXPECT_EQ(farthest_corner({face.begin(), face.end()}, regions[i]), 0);
    EXPECT_NEAR((area(regions[i]) - area({face.begin(), face.end()})).norm(), 0, 1e-12);
  }
}

TEST(RegionClipper, NoFacesNoRegions) {
  GlContext context;
  const ShaftAxis axis{Vector3d(0, 0, 0), Vector3d(0, 0, 1)};
  const TriangleMesh mesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2});
  RegionClipper clipper(context);
  EXPECT_TRUE(clipper.clip(conservative_volume({axis, axis}, 0.1, {}), mesh, {}).empty());
}

// The result is larger than the initial buffer.
TEST(RegionClipper, ManyFacesAtOnce) {
  GlContext context;
  const ShaftAxis axis{Vector3d(0, 0, 0), Vector3d(0, 0, 1)};
  const TriangleMesh mesh({-1, 0, 0.5F, 1, 0.5F, 0.5F, 1, -0.5F, 0.6F}, {0, 1, 2});
  const std::vector<Region> regions = RegionClipper(context).clip(
      conservative_volume({axis, axis}, 0.1, {}), mesh, std::vector<std::uint32_t>(5000, 0));
  ASSERT_EQ(regions.size(), 5000u);
  for (const Region& region : regions) EXPECT_EQ(region, regions[0]);
  EXPECT_GE(regions[0].size(), 4u);
}

}  // namespace
}  // namespace organ_collision
