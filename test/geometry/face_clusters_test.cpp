#include "organ_collision/geometry/face_clusters.hpp"

#include <gtest/gtest.h>

#include <set>

#include "grid_surface.hpp"

namespace organ_collision {
namespace {

/// Every face is in one cluster, by rising numbers, and all its vertices are in the cluster's
/// blocks.
void expect_covering(const FaceClusters& clusters, const std::vector<FaceIndices>& faces,
                     std::size_t vertex_count) {
  std::vector<std::uint32_t> place(vertex_count);
  for (std::uint32_t i = 0; i < vertex_count; ++i) {
    place[clusters.order().empty() ? i : clusters.order()[i]] = i;
  }
  std::vector<int> seen(faces.size(), 0);
  for (std::size_t cluster = 0; cluster < clusters.count(); ++cluster) {
    const auto blocks = clusters.blocks(cluster);
    const std::set<std::uint32_t> block_set(blocks.begin(), blocks.end());
    EXPECT_EQ(block_set.size(), static_cast<std::size_t>(blocks.end() - blocks.begin()));
    const auto members = clusters.faces(cluster);
    EXPECT_TRUE(std::is_sorted(members.begin(), members.end()));
    EXPECT_NE(members.begin(), members.end());
    for (const std::uint32_t face : members) {
      ++seen[face];
      for (const std::uint32_t vertex : faces[face]) {
        EXPECT_TRUE(block_set.count(place[vertex] / FaceClusters::kBlockSize));
      }
    }
  }
  EXPECT_EQ(seen, std::vector<int>(faces.size(), 1));
}

TEST(FaceClusters, CoverEveryFaceOfACoherentSurface) {
  for (const int side : {1, 2, 9, 40, 101}) {
    const GridSurface grid = grid_surface(side);
    const FaceClusters clusters(grid.faces, grid.vertices);
    EXPECT_TRUE(clusters.order().empty());
    expect_covering(clusters, grid.faces, grid.vertices.size() / 3);
  }
}

TEST(FaceClusters, ReorderAShuffledSurfaceIntoCompactBlocks) {
  const GridSurface grid = shuffled(grid_surface(101), 5);
  const FaceClusters clusters(grid.faces, grid.vertices);
  ASSERT_EQ(clusters.order().size(), grid.vertices.size() / 3);
  expect_covering(clusters, grid.faces, grid.vertices.size() / 3);
  std::size_t blocks = 0;
  for (std::size_t i = 0; i < clusters.count(); ++i) {
    blocks += static_cast<std::size_t>(clusters.blocks(i).end() - clusters.blocks(i).begin());
  }
  EXPECT_LT(blocks, 6 * clusters.count());
}

TEST(FaceClusters, TakeSoupsFansAndVerticesWithoutFaces) {
  std::vector<float> vertices(3 * 300, 0.25F);
  std::vector<FaceIndices> fan;
  for (std::uint32_t i = 1; i + 1 < 300; ++i) fan.push_back({0, i, i + 1});
  expect_covering(FaceClusters(fan, vertices), fan, 300);
  const std::vector<FaceIndices> one = {{299, 150, 299}};
  expect_covering(FaceClusters(one, vertices), one, 300);
}

}  // namespace
}  // namespace organ_collision
