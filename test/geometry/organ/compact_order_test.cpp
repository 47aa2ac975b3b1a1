#include "geometry/organ/compact_order.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "test/grid_surface.hpp"

namespace organ_collision {
namespace {

using Numbers = std::vector<std::uint32_t>;

Eigen::Vector3f place(const std::vector<float>& vertices, std::uint32_t vertex) {
  return Eigen::Map<const Eigen::Vector3f>(&vertices[3 * vertex]);
}

/// The mean diagonal of the boxes around the aligned groups of so many pieces [m].
double mean_diagonal(const std::vector<float>& vertices, const Numbers& order, std::size_t size) {
  double sum = 0.0;
  std::size_t groups = 0;
  for (std::size_t begin = 0; begin < order.size(); begin += size, ++groups) {
    Eigen::AlignedBox3f box;
    for (std::size_t i = begin; i < std::min(begin + size, order.size()); ++i) {
      box.extend(place(vertices, order[i]));
    }
    sum += box.diagonal().norm();
  }
  return sum / static_cast<double>(groups);
}

void expect_each_piece_once(Numbers order, std::size_t vertex_count, std::size_t piece) {
  std::sort(order.begin(), order.end());
  Numbers expected;
  for (std::uint32_t i = 0; i < vertex_count; i += static_cast<std::uint32_t>(piece)) {
    expected.push_back(i);
  }
  EXPECT_EQ(order, expected);
}

TEST(CompactOrder, HasEachPieceOnce) {
  for (const int side : {1, 2, 7, 40}) {
    const GridSurface grid = grid_surface(side);
    const std::size_t count = grid.vertices.size() / 3;
    for (const std::size_t piece : {1, 3, 8, 5000}) {
      for (const std::size_t together : {1, 2, 16}) {
        expect_each_piece_once(compact_order(grid.vertices, piece, together), count, piece);
      }
    }
  }
}

// A square patch of n points of a grid is as compact as a group can be.
TEST(CompactOrder, MakesEachAlignedGroupCompact) {
  constexpr int kSide = 127;
  const GridSurface grid = shuffled(grid_surface(kSide), 7);
  const Numbers order = compact_order(grid.vertices, 1, 1);
  for (const int width : {4, 16, 64}) {
    const double square = std::sqrt(2.0) * 0.2 * (width - 1) / kSide;
    const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(width);
    // The sheet is wavy, so that the sides of its patches are longer than those of their boxes.
    EXPECT_LT(mean_diagonal(grid.vertices, order, size), 1.25 * square) << size;
  }
}

TEST(CompactOrder, DoesNotDependOnTheOrderOfPlacesThatDiffer) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> coordinate(-1.0F, 1.0F);
  std::vector<float> vertices(3 * 1000);
  for (float& value : vertices) value = coordinate(random);
  std::vector<float> reversed;
  for (std::size_t i = 1000; i-- > 0;) {
    reversed.insert(reversed.end(), &vertices[3 * i], &vertices[3 * i] + 3);
  }
  const Numbers order = compact_order(vertices, 1, 1);
  Numbers of_reversed = compact_order(reversed, 1, 1);
  for (std::uint32_t& vertex : of_reversed) vertex = 999 - vertex;
  EXPECT_EQ(of_reversed, order);
}

TEST(CompactOrder, TakesPlacesThatAreAllTheSame) {
  const std::vector<float> vertices(3 * 500, 0.25F);
  expect_each_piece_once(compact_order(vertices, 1, 1), 500, 1);
}

}  // namespace
}  // namespace organ_collision
