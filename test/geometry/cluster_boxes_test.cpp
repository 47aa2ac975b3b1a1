#include "organ_collision/geometry/cluster_boxes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "grid_surface.hpp"

namespace organ_collision {
namespace {

Eigen::Vector3d vertex(const GridSurface& grid, std::uint32_t index) {
  return Eigen::Map<const Eigen::Vector3f>(&grid.vertices[3 * index]).cast<double>();
}

bool contains_all_faces(const ClusterBoxes& boxes, const FaceClusters& clusters,
                        const GridSurface& grid) {
  for (std::size_t cluster = 0; cluster < clusters.count(); ++cluster) {
    const Eigen::AlignedBox3d box = boxes.box(cluster).cast<double>();
    for (const std::uint32_t face : clusters.faces(cluster)) {
      for (const std::uint32_t corner : grid.faces[face]) {
        if (!box.contains(vertex(grid, corner))) return false;
      }
    }
  }
  return true;
}

TEST(ClusterBoxes, ContainTheirFacesInEveryShape) {
  for (const int side : {1, 7, 30, 64, 101}) {
    for (const bool shuffle : {false, true}) {
      const GridSurface rest = shuffle ? shuffled(grid_surface(side), 3) : grid_surface(side);
      const FaceClusters clusters(rest.faces, rest.vertices);
      ClusterBoxes boxes;
      for (const double phase : {0.0, 0.4, 2.1}) {
        const GridSurface grid =
            shuffle ? shuffled(grid_surface(side, phase), 3) : grid_surface(side, phase);
        ASSERT_TRUE(boxes.refit(clusters, grid.vertices));
        EXPECT_TRUE(contains_all_faces(boxes, clusters, grid)) << side << ' ' << phase;
        const Eigen::Map<const Eigen::Matrix3Xf> all(
            grid.vertices.data(), 3, static_cast<Eigen::Index>(grid.vertices.size() / 3));
        EXPECT_EQ(boxes.all().min(), all.rowwise().minCoeff());
        EXPECT_EQ(boxes.all().max(), all.rowwise().maxCoeff());
      }
    }
  }
}

TEST(ClusterBoxes, NoticeEveryCoordinateThatIsNotFinite) {
  for (const bool shuffle : {false, true}) {
    const GridSurface grid = shuffle ? shuffled(grid_surface(20), 3) : grid_surface(20);
    const FaceClusters clusters(grid.faces, grid.vertices);
    ClusterBoxes boxes;
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

/// Whether all of a face is outside of one of the half-spaces.
bool outside(const GridSurface& grid, const FaceIndices& face,
             const std::vector<HalfSpace>& half_spaces, const Eigen::Vector3d& origin) {
  for (const HalfSpace& h : half_spaces) {
    const auto over = [&](std::uint32_t corner) {
      return h.normal.dot(vertex(grid, corner) - origin) > h.offset;
    };
    if (over(face[0]) && over(face[1]) && over(face[2])) return true;
  }
  return false;
}

TEST(ClusterBoxes, MeetEveryVolumeThatOneOfTheirFacesMayMeet) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] {
    return Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  };
  for (const double far : {0.0, 3.0, 1000.0}) {
    GridSurface grid = grid_surface(64);
    for (float& x : grid.vertices) x += static_cast<float>(far);
    const FaceClusters clusters(grid.faces, grid.vertices);
    ClusterBoxes boxes;
    ASSERT_TRUE(boxes.refit(clusters, grid.vertices));
    std::size_t left_out = 0;
    for (int trial = 0; trial < 200; ++trial) {
      // A prism around a point near the surface; its planes pass exactly through vertices.
      const Eigen::Vector3d origin = Eigen::Vector3d::Constant(far) + 0.1 * vector();
      std::vector<HalfSpace> half_spaces;
      for (int i = 0; i < 8; ++i) {
        const Eigen::Vector3d normal = vector().normalized();
        const auto nearest = static_cast<std::uint32_t>(random() % (grid.vertices.size() / 3));
        half_spaces.push_back({normal, std::abs(normal.dot(vertex(grid, nearest) - origin)) * 0.2});
      }
      std::vector<std::uint32_t> meeting;
      boxes.find_meeting(half_spaces, origin, meeting);
      EXPECT_TRUE(std::is_sorted(meeting.begin(), meeting.end()));
      left_out += clusters.count() - meeting.size();
      std::vector<bool> met(clusters.count(), false);
      for (const std::uint32_t cluster : meeting) met[cluster] = true;
      for (std::size_t cluster = 0; cluster < clusters.count(); ++cluster) {
        if (met[cluster]) continue;
        for (const std::uint32_t face : clusters.faces(cluster)) {
          EXPECT_TRUE(outside(grid, grid.faces[face], half_spaces, origin));
        }
      }
    }
    EXPECT_GT(left_out, 100 * clusters.count()) << "hardly any cluster was left out";
  }
}

}  // namespace
}  // namespace organ_collision
