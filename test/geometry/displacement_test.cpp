#include "organ_collision/geometry/displacement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace organ_collision {
namespace {

const std::vector<std::uint32_t> kTetrahedron = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
const std::vector<float> kCorners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

TEST(LargestDisplacement, IsThatOfTheVertexThatMovedFarthest) {
  std::mt19937 random(20);
  std::uniform_real_distribution<float> coordinate(-3.0F, 3.0F);
  for (std::size_t trial = 0; trial < 400; ++trial) {
    const std::size_t size = 3 * (4 + trial % 40);
    const float step = std::pow(10.0F, -static_cast<float>(trial % 12));
    std::vector<float> before(size), now(size);
    for (float& x : before) x = coordinate(random);
    for (std::size_t i = 0; i < size; ++i) now[i] = before[i] + step * coordinate(random);
    double farthest = 0.0;
    for (std::size_t v = 0; v < size; v += 3) {
      farthest = std::max(farthest,
                          std::hypot(double(now[v]) - before[v], double(now[v + 1]) - before[v + 1],
                                     double(now[v + 2]) - before[v + 2]));
    }
    const double found =
        largest_displacement(TriangleMesh(before, kTetrahedron), TriangleMesh(now, kTetrahedron));
    EXPECT_GE(found, farthest);
    EXPECT_LE(found, farthest * (1.0 + 2e-6));
  }
}

std::vector<float> with_tip_at(float z) {
  std::vector<float> corners = kCorners;
  corners.back() = z;
  return corners;
}

TEST(LastDisplacement, IsFoundAnewForEachPairOfShapes) {
  const TriangleMesh rest(kCorners, kTetrahedron);
  TriangleMesh before = rest, now = rest;
  LastDisplacement displacement;
  EXPECT_EQ(displacement.between(before, now), 0.0);
  for (const float z : {1.5F, 1.75F, 1.75F, 3.0F}) {
    now.move_vertices(with_tip_at(z));
    EXPECT_DOUBLE_EQ(displacement.between(before, now), largest_displacement(before, now));
    EXPECT_DOUBLE_EQ(displacement.between(before, now), largest_displacement(before, now));
    EXPECT_DOUBLE_EQ(displacement.between(rest, now), largest_displacement(rest, now));
    EXPECT_DOUBLE_EQ(displacement.between(now, rest), largest_displacement(rest, now));
    std::swap(before, now);
  }
}

// Allocators give freed memory out again: an address alone does not tell shapes apart.
TEST(LastDisplacement, IsNotThatOfShapesThatAreGone) {
  LastDisplacement displacement;
  const TriangleMesh rest(kCorners, kTetrahedron);
  for (int i = 1; i < 50; ++i) {
    const TriangleMesh now(with_tip_at(1.0F + static_cast<float>(i)), kTetrahedron);
    EXPECT_NEAR(displacement.between(rest, now), i, 1e-4);
  }
}

}  // namespace
}  // namespace organ_collision
