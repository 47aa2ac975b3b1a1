#include "organ_collision/geometry/organ/block_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "test/grid_surface.hpp"

namespace organ_collision {
namespace {

constexpr std::size_t kGroup = FaceClusters::kGroup;

Eigen::Array3f vertex(const GridSurface& grid, std::uint32_t index) {
  return Eigen::Map<const Eigen::Array3f>(&grid.vertices[3 * index]);
}

/// The smallest box around the points point(0) to point(count - 1).
template <typename Point>
Eigen::AlignedBox3f box_around(std::size_t count, const Point& point) {
  Eigen::AlignedBox3f box;
  for (std::size_t i = 0; i < count; ++i) box.extend(Eigen::Vector3f(point(i).matrix()));
  return box;
}

Eigen::AlignedBox3f plain(const BlockBoxes::Box& box) {
  return {box.min.head<3>().matrix(), box.max.head<3>().matrix()};
}

TEST(BlockBoxes, KeepNothingOfOtherClusters) {
  const GridSurface large = grid_surface(64), small = grid_surface(7);
  const FaceClusters of_large(large.faces, large.vertices), of_small(small.faces, small.vertices);
  BlockBoxes reused, fresh;
  ASSERT_TRUE(reused.refit(of_large, large.vertices));
  ASSERT_TRUE(reused.refit(of_small, small.vertices));
  ASSERT_TRUE(fresh.refit(of_small, small.vertices));
  EXPECT_TRUE(reused.all().isApprox(fresh.all(), 0.0F));
  ASSERT_EQ(reused.groups(0).size(), fresh.groups(0).size());
  for (std::size_t i = 0; i < fresh.groups(0).size(); ++i) {
    EXPECT_TRUE((reused.groups(0)[i].min == fresh.groups(0)[i].min).all());
    EXPECT_TRUE((reused.groups(0)[i].max == fresh.groups(0)[i].max).all());
  }
}

TEST(BlockBoxes, AreTheSmallestInEveryShape) {
  for (const int side : {1, 7, 30, 64, 150}) {
    for (const bool shuffle : {false, true}) {
      const GridSurface rest = shuffle ? shuffled(grid_surface(side), 3) : grid_surface(side);
      const FaceClusters clusters(rest.faces, rest.vertices);
      BlockBoxes boxes;
      for (const double phase : {0.0, 0.4, 2.1}) {
        const GridSurface grid =
            shuffle ? shuffled(grid_surface(side, phase), 3) : grid_surface(side, phase);
        ASSERT_TRUE(boxes.refit(clusters, grid.vertices));
        for (std::size_t block = 0; block < clusters.block_count(); ++block) {
          const auto corner = [&](std::size_t i) {
            return vertex(grid, clusters.vertices(block)[i]);
          };
          EXPECT_TRUE(plain(boxes.blocks()[block])
                          .isApprox(box_around(FaceClusters::kBlock, corner), 0.0F));
        }
        std::vector<Eigen::AlignedBox3f> members;
        for (std::size_t block = 0; block < clusters.block_count(); ++block) {
          members.push_back(plain(boxes.blocks()[block]));
          for (const std::uint32_t part : clusters.blocks(block)) {
            const bool is_beyond = part / kGroup != block / kGroup;
            if (is_beyond) members.back().extend(plain(boxes.blocks()[part]));
          }
        }
        for (std::size_t level = 0; level < clusters.level_count(); ++level) {
          std::vector<Eigen::AlignedBox3f> groups(clusters.group_count(level));
          for (std::size_t i = 0; i < members.size(); ++i) groups[i / kGroup].extend(members[i]);
          for (std::size_t group = 0; group < groups.size(); ++group) {
            EXPECT_TRUE(plain(boxes.groups(level)[group]).isApprox(groups[group], 0.0F));
          }
          members = groups;
        }
        const auto any = [&](std::size_t i) { return vertex(grid, static_cast<std::uint32_t>(i)); };
        EXPECT_TRUE(boxes.all().isApprox(box_around(grid.vertices.size() / 3, any), 0.0F));
      }
    }
  }
}

TEST(BlockBoxes, NoticeEveryCoordinateThatIsNotFinite) {
  for (const bool shuffle : {false, true}) {
    const GridSurface grid = shuffle ? shuffled(grid_surface(20), 3) : grid_surface(20);
    const FaceClusters clusters(grid.faces, grid.vertices);
    BlockBoxes boxes;
    for (std::size_t i = 0; i < grid.vertices.size(); ++i) {
      for (const float bad :
           {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
        std::vector<float> vertices = grid.vertices;
        vertices[i] = bad;
        EXPECT_FALSE(boxes.refit(clusters, vertices)) << i;
      }
    }
    std::vector<float> largest(grid.vertices.size(), std::numeric_limits<float>::max());
    EXPECT_TRUE(boxes.refit(clusters, largest));
  }
}

}  // namespace
}  // namespace organ_collision
