#include "organ_collision/geometry/organ/face_clusters.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
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

TEST(FaceClusters, ReorderAShuffledSurfaceIntoCompactBlocks) {
  const GridSurface grid = shuffled(grid_surface(101), 5);
  const FaceClusters clusters(grid.faces, grid.vertices);
  const std::size_t vertex_count = grid.vertices.size() / 3;
  expect_covering(clusters, grid.faces, vertex_count);
  EXPECT_EQ(clusters.piece_size(), 1U);
  EXPECT_EQ(blocks_by_pieces(clusters, vertex_count), blocks_of_vertices(clusters, vertex_count));
  EXPECT_LT(blocks_of_all_clusters(clusters), 5 * clusters.block_count());
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

}  // namespace
}  // namespace organ_collision
