#include "organ_collision/geometry/tool/tool_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "organ_collision/geometry/tolerances.hpp"
#include "tool_meshes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;
using Reason = MeshError::Reason;

/// [m] How far a point is outside a box.
double outside(const OrientedBox& box, const Vector3d& point) {
  const Vector3d from_center = box.axes.transpose() * (point - box.center);
  return std::max(0.0, (from_center.cwiseAbs() - box.half_size).maxCoeff());
}

/// Checks every node of a tree.
class TreeCheck {
 public:
  explicit TreeCheck(const ToolSurface& surface)
      : surface_(surface), rounding_(1e-15 * reach(surface.nodes().front().box)) {}

  /// Returns the depth of the tree below a node.
  int depth(std::uint32_t index = 0) {
    ++visited_;
    const ToolSurface::Node& node = surface_.nodes()[index];
    expect_holds_its_faces(node);
    if (node.second == 0) {
      for (std::uint32_t face = node.begin; face < node.end; ++face) ++in_leaves_[face];
      return 1;
    }
    const ToolSurface::Node &first = surface_.nodes()[index + 1],
                            &second = surface_.nodes()[node.second];
    EXPECT_EQ(first.begin, node.begin);
    EXPECT_EQ(first.end, second.begin);
    EXPECT_EQ(second.end, node.end);
    EXPECT_LT(first.begin, first.end);
    EXPECT_LT(second.begin, second.end);
    return 1 + std::max(depth(index + 1), depth(node.second));
  }

  std::size_t visited() const { return visited_; }
  const std::vector<int>& in_leaves() const { return in_leaves_; }

 private:
  void expect_holds_its_faces(const ToolSurface::Node& node) const {
    const OrientedBox& box = node.box;
    EXPECT_LE((box.axes * box.axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_GT(box.axes.determinant(), 0.0);
    EXPECT_GE(box.half_size.minCoeff(), 0.0);
    for (std::uint32_t face = node.begin; face < node.end; ++face) {
      for (const Vector3d& corner : surface_.triangle(face)) {
        EXPECT_LE(outside(box, corner), rounding_);
      }
    }
  }

  static double reach(const OrientedBox& box) { return box.center.norm() + box.half_size.norm(); }

  const ToolSurface& surface_;
  const double rounding_;  ///< [m]
  std::size_t visited_ = 0;
  std::vector<int> in_leaves_ = std::vector<int>(surface_.faces().size());
};

/// The coordinates of each face's corners, in sorted order.
std::vector<std::array<double, 9>> sorted(const std::vector<FaceIndices>& faces,
                                          const std::vector<Vector3d>& vertices) {
  std::vector<std::array<double, 9>> corners;
  for (const FaceIndices& face : faces) {
    const Vector3d &a = vertices[face[0]], &b = vertices[face[1]], &c = vertices[face[2]];
    corners.push_back({a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), c.x(), c.y(), c.z()});
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

void expect_tree(const ToolMesh& mesh) {
  const ToolSurface surface = mesh.surface();
  EXPECT_EQ(sorted(surface.faces(), surface.vertices()), sorted(mesh.faces, mesh.vertices))
      << "in another order, corners as given";
  std::vector<bool> used(surface.vertices().size());
  for (const FaceIndices& face : surface.faces()) {
    for (const std::uint32_t corner : face) used[corner] = true;
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
  ASSERT_FALSE(surface.nodes().empty());
  EXPECT_EQ(surface.nodes().front().begin, 0U);
  EXPECT_EQ(surface.nodes().front().end, mesh.faces.size());
  TreeCheck check(surface);
  EXPECT_LE(check.depth(), 2.0 + std::log2(static_cast<double>(mesh.faces.size())));
  EXPECT_EQ(check.visited(), surface.nodes().size()) << "every node is a child of one";
  for (const int times : check.in_leaves()) EXPECT_EQ(times, 1);
}

TEST(ToolSurface, HasEachFaceInOneLeafAndInItsAncestorsBoxes) {
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    expect_tree(scattered_mesh(static_cast<std::size_t>(random.integer(1, 200)), random));
  }
  expect_tree(wavy_mesh(16, 0.3));
  expect_tree(box_mesh(oracle::random_pose(0.1, random), {0.02, 0.03, 1e-4}));
}

TEST(ToolSurface, OfFacesThatAreAllTheSameIsATreeAsWell) {
  ToolMesh mesh;
  mesh.vertices = {{0.1, 0.2, 0.3}, {0.2, 0.1, 0.3}, {0.3, 0.1, 0.1}};
  mesh.faces.assign(1000, {0, 1, 2});
  expect_tree(mesh);
  mesh.faces.assign(1000, {1, 1, 1});
  expect_tree(mesh);
}

TEST(ToolSurface, ProjectsOntoADirectionAsItsVertices) {
  Random random(4);
  for (const std::size_t faces : {1, 150, 3000}) {
    const ToolSurface surface = scattered_mesh(faces, random).surface();
    for (int i = 0; i < 300; ++i) {
      const Vector3d direction = random.scale(1e-3, 1e3) * random.direction();
      double lowest = INFINITY, highest = -INFINITY;
      for (const Vector3d& vertex : surface.vertices()) {
        lowest = std::min(lowest, direction.dot(vertex));
        highest = std::max(highest, direction.dot(vertex));
      }
      const ProjectionInterval found = surface.project_onto(direction);
      EXPECT_NEAR(found.low, lowest, 1e-15 * direction.norm());
      EXPECT_NEAR(found.high, highest, 1e-15 * direction.norm());
    }
  }
}

// A sheet lies flat in its boxes in every orientation.
TEST(ToolSurface, BoxesAreTurnedWithTheFaces) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Isometry3d pose = oracle::random_pose(0.1, random);
    ToolMesh mesh = wavy_mesh(16, 1.0);
    for (Vector3d& vertex : mesh.vertices) vertex = pose * Vector3d(vertex.x(), vertex.y(), 0.0);
    const ToolSurface surface = mesh.surface();
    for (const ToolSurface::Node& node : surface.nodes()) {
      EXPECT_LE(node.box.half_size.minCoeff(), 1e-9);
    }
  }
}

/// Checks that the mesh is refused for `reason`, with `word` in the message.
void expect_refused(Reason reason, const std::string& word, const ToolMesh& mesh) {
  try {
    mesh.surface();
    ADD_FAILURE() << "was accepted";
  } catch (const MeshError& error) {
    EXPECT_EQ(error.reason(), reason) << error.what();
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

TEST(ToolSurface, RefusesWhatIsNoMesh) {
  Random random(3);
  const ToolMesh good = scattered_mesh(5, random);
  const auto with_vertex = [&](std::size_t index, const Vector3d& vertex) {
    ToolMesh mesh = good;
    mesh.vertices[index] = vertex;
    return mesh;
  };
  expect_refused(Reason::kNoTriangles, "no triangle", {good.vertices, {}});
  expect_refused(Reason::kNoTriangles, "no triangle", {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused(Reason::kNotFinite, "vertex 4", with_vertex(4, {0.0, nan, 0.0}));
  expect_refused(Reason::kNotFinite, "vertex 2", with_vertex(2, {0.0, 0.0, -INFINITY}));
  expect_refused(Reason::kTooFar, "vertex 3",
                 with_vertex(3, {1.01 * tolerance::kFarthest, 0.0, 0.0}));
  ToolMesh wrong = good;
  wrong.faces[3][1] = 15;
  expect_refused(Reason::kIndex, "face 3 names vertex 15 of 15", wrong);
  expect_refused(Reason::kIndex, "face 0", {{}, {FaceIndices{0, 1, 2}}});
}

}  // namespace
}  // namespace organ_collision
