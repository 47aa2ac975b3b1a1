#include "organ_collision/geometry/organ/face_clusters.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "test/grid_surface.hpp"

namespace organ_collision {
namespace {

constexpr std::size_t kGroup = FaceClusters::kGroup;

std::vector<std::uint32_t> blocks_of_vertices(const FaceClusters& clusters, std::size_t count) {
  std::vector<std::uint32_t> block_of(count, ~0U);
  for (std::uint32_t block = 0; block < clusters.block_count(); ++block) {
    for (std::size_t i = 0; i < FaceClusters::kBlock; ++i) {
      const std::uint32_t vertex = clusters.vertices(block)[i];
      EXPECT_TRUE(block_of[vertex] == ~0U || block_of[vertex] == block) << "in two blocks";
      block_of[vertex] = block;
    }
  }
  for (const std::uint32_t block : block_of) EXPECT_NE(block, ~0U) << "in no block";
  return block_of;
}

/// The block of each vertex as block_of_piece() tells it.
std::vector<std::uint32_t> blocks_by_pieces(const FaceClusters& clusters, std::size_t count) {
  std::vector<std::uint32_t> block_of;
  EXPECT_EQ(clusters.block_of_piece().size(), (count - 1) / clusters.piece_size() + 1);
  for (std::size_t i = 0; i < count; ++i) {
    block_of.push_back(clusters.block_of_piece()[i / clusters.piece_size()]);
  }
  return block_of;
}

/// The set of numbers, each of which must occur once.
std::set<std::uint32_t> set_of(const FaceClusters::Range<std::uint32_t>& range) {
  const std::set<std::uint32_t> set(range.begin(), range.end());
  EXPECT_EQ(set.size(), static_cast<std::size_t>(range.end() - range.begin()));
  return set;
}

/// Checks that every face is in one cluster, by rising numbers, that its vertices are in the
/// cluster's blocks, and that these blocks belong to the section or to its border.
void expect_covering(const FaceClusters& clusters, const std::vector<FaceIndices>& faces,
                     std::size_t vertex_count) {
  const std::vector<std::uint32_t> block_of = blocks_of_vertices(clusters, vertex_count);
  std::vector<int> seen(faces.size(), 0);
  for (std::size_t block = 0; block < clusters.block_count(); ++block) {
    const std::set<std::uint32_t> blocks = set_of(clusters.blocks(block));
    const std::set<std::uint32_t> border = set_of(clusters.border(block / kGroup));
    for (const std::uint32_t part : blocks) {
      EXPECT_EQ(border.count(part), part / kGroup == block / kGroup ? 0U : 1U);
    }
    std::uint32_t last = 0;
    for (const FaceClusters::Face& face : clusters.faces(block)) {
      EXPECT_EQ(face.corners, faces[face.number]);
      EXPECT_LE(last, face.number);
      last = face.number;
      ++seen[face.number];
      for (const std::uint32_t vertex : face.corners) EXPECT_TRUE(blocks.count(block_of[vertex]));
    }
  }
  EXPECT_EQ(seen, std::vector<int>(faces.size(), 1));
}

std::size_t blocks_of_all_clusters(const FaceClusters& clusters) {
  std::size_t blocks = 0;
  for (std::size_t i = 0; i < clusters.block_count(); ++i)
    blocks += set_of(clusters.blocks(i)).size();
  return blocks;
}

TEST(FaceClusters, TakeBlocksOfACoherentSurface) {
  for (const int side : {1, 2, 9, 40, 101}) {
    const GridSurface grid = grid_surface(side);
    const FaceClusters clusters(grid.faces, grid.vertices);
    const std::size_t vertex_count = grid.vertices.size() / 3;
    expect_covering(clusters, grid.faces, vertex_count);
    EXPECT_LT(blocks_of_all_clusters(clusters), 5 * clusters.block_count());
    EXPECT_EQ(clusters.piece_size(), FaceClusters::kBlock);
    EXPECT_EQ(blocks_by_pieces(clusters, vertex_count), blocks_of_vertices(clusters, vertex_count));
  }
}

TEST(FaceClusters, TakeSoupsFansAndVerticesWithoutFaces) {
  std::vector<float> vertices(3 * 300, 0.25F);
  std::vector<FaceIndices> fan;
  for (std::uint32_t i = 1; i + 1 < 300; ++i) fan.push_back({0, i, i + 1});
  expect_covering(FaceClusters(fan, vertices), fan, 300);
  const std::vector<FaceIndices> one = {{299, 150, 299}};
  expect_covering(FaceClusters(one, vertices), one, 300);
  vertices[0] = 1e6F;  // One vertex is far from all others.
  expect_covering(FaceClusters(fan, vertices), fan, 300);
}

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

}  // namespace
}  // namespace organ_collision
