#include "outcodes.hpp"

#include <gtest/gtest.h>

#include <random>

#include "grid_surface.hpp"

namespace organ_collision {
namespace {

/// What 32 bits may misplace, as a share of the largest coordinate: a quarter of what volumes grow.
constexpr double kBand = 2.5e-7;

std::vector<HalfSpace> random_half_spaces(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<HalfSpace> half_spaces;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d normal(uniform(random), uniform(random), uniform(random));
    half_spaces.push_back({normal.normalized(), 0.1 * uniform(random)});
  }
  return half_spaces;
}

/// How far the face's nearest corner is outside of the half-space that it is farthest outside of.
double farthest_outside(const Triangle& face, const std::vector<HalfSpace>& half_spaces,
                        const Eigen::Vector3d& origin) {
  double farthest = -1e9;
  for (const HalfSpace& h : half_spaces) {
    double nearest = 1e9;
    for (const Eigen::Vector3d& corner : face) {
      nearest = std::min(nearest, h.normal.dot(corner - origin) - h.offset);
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

TEST(Outcodes, RejectTheFacesOutsideOfOneHalfSpace) {
  std::mt19937 random(17);
  std::size_t rejected = 0;
  for (const float far : {0.0F, 2.5F, 1000.0F}) {
    for (const bool shuffle : {false, true}) {
      GridSurface grid = shuffle ? shuffled(grid_surface(33), 2) : grid_surface(33);
      for (float& x : grid.vertices) x += far;
      const TriangleMesh mesh(grid.vertices, grid.triangles());
      Outcodes outcodes;
      for (std::size_t count = 1; count <= 14; ++count) {
        const std::vector<HalfSpace> half_spaces = random_half_spaces(random, count);
        const Eigen::Vector3d origin = Eigen::Vector3d(0.11, -0.23, 0.07).array() + far;
        outcodes.assign(half_spaces, origin, mesh);
        for (std::size_t i = 0; i < mesh.clusters().count(); ++i) outcodes.add_cluster(i);
        for (std::size_t i = 0; i < mesh.face_count(); ++i) {
          const double outside = farthest_outside(mesh.triangle(i), half_spaces, origin);
          if (std::abs(outside) < kBand) continue;
          ASSERT_EQ(outcodes.is_outside(mesh.faces()[i]), outside > 0.0) << i << ' ' << outside;
          rejected += outside > 0.0;
        }
      }
    }
  }
  EXPECT_GT(rejected, 10000U);
}

TEST(Outcodes, StartAnewForAnotherShape) {
  Outcodes outcodes;
  const std::vector<HalfSpace> above = {{Eigen::Vector3d::UnitZ(), 0.5}};
  TriangleMesh mesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2});
  outcodes.assign(above, Eigen::Vector3d::Zero(), mesh);
  outcodes.add_cluster(0);
  EXPECT_FALSE(outcodes.is_outside(mesh.faces()[0]));
  mesh.move_vertices(std::vector<float>{0, 0, 1, 1, 0, 1, 0, 1, 1});
  outcodes.assign(above, Eigen::Vector3d::Zero(), mesh);
  outcodes.add_cluster(0);
  EXPECT_TRUE(outcodes.is_outside(mesh.faces()[0]));
}

}  // namespace
}  // namespace organ_collision
