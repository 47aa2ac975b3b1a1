// The surfaces of tools: their trees of boxes, and how they touch faces.
#include "organ_collision/geometry/tool/tool_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geometry/distance/first_touch.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "test/proof/trial_suites.hpp"
#include "tool_meshes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;
using Reason = MeshError::Reason;

/// The first touch of one face, from every triangle alone, without boxes.
std::optional<FirstTouch> by_all_pairs(const ToolMesh& mesh, const RigidMotion& motion,
                                       double radius, const FaceMotion& face) {
  std::optional<FirstTouch> first;
  for (const auto& [a, b, c] : mesh.faces) {
    const ConvexCore core(Triangle{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
    const auto touch = first_touch(CoreMotion(core, motion), face, radius);
    if (touch && (!first || touch->time < first->time)) first = touch;
  }
  return first;
}

/// Faces of an organ around a tool, some at rest and some moving. Some have a touch that is left
/// from an earlier query.
std::vector<FaceTouch> faces_around(const Eigen::Isometry3d& pose, std::uint32_t count,
                                    Random& random) {
  std::vector<FaceTouch> faces;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vector3d center = pose * random.point(0.05);
    const double size = random.scale(1e-3, 0.05);
    Triangle corners;
    for (Vector3d& corner : corners) corner = center + size * random.direction();
    faces.push_back({100 + i, oracle::motion_to(corners, random), {}});
    if (random.chance(0.3)) {
      const ConvexCore core(corners);
      faces.back().first = first_touch(CoreMotion(core, {pose, pose}), {corners, corners}, 1.0);
    }
  }
  return faces;
}

void expect_as_all_pairs(const ToolMesh& mesh, const RigidMotion& motion, double radius,
                         std::vector<FaceTouch> faces, int& touched) {
  const std::vector<FaceTouch> asked = faces;
  WorkBudget unlimited = WorkBudget::unlimited();
  SurfaceTouches().find(mesh.surface(), motion, radius, unlimited, faces);
  ASSERT_EQ(faces.size(), asked.size());
  std::sort(faces.begin(), faces.end(),
            [](const auto& a, const auto& b) { return a.face < b.face; });
  for (std::size_t i = 0; i < faces.size(); ++i) {
    ASSERT_EQ(faces[i].face, asked[i].face);
    EXPECT_EQ(faces[i].motion.start, asked[i].motion.start);
    const auto expected = by_all_pairs(mesh, motion, radius, asked[i].motion);
    ASSERT_EQ(faces[i].first.has_value(), expected.has_value());
    if (!expected) continue;
    ++touched;
    // Both distances are within kTouch of the radius.
    EXPECT_NEAR(faces[i].first->time, expected->time, 1e-6);
    if (expected->time > 0.0) {
      EXPECT_NEAR(faces[i].first->closest.distance, radius, 2.0 * tolerance::kTouch);
    } else {
      EXPECT_LE(faces[i].first->closest.distance, radius);
    }
  }
}

// So each triangle is in a leaf of the tree, and in the boxes above it.
TEST(SurfaceTouch, IsTheFirstOfAllPairs) {
  Random random(1);
  int touched = 0;
  for (int i = 0; i < 500 && !testing::Test::HasFailure(); ++i) {
    const ToolMesh mesh =
        i % 3 == 0 ? wavy_mesh(random.integer(1, 6), random.uniform(0.1, 0.5))
                   : scattered_mesh(static_cast<std::size_t>(random.integer(1, 60)), random);
    const Eigen::Isometry3d start = oracle::random_pose(0.3, random);
    Eigen::Isometry3d end = start;
    if (random.chance(0.8)) end.linear() *= oracle::random_turn(random.scale(1e-6, 3.1), random);
    if (random.chance(0.8)) end.translation() += random.scale(1e-6, 0.2) * random.direction();
    const double radius = random.chance(0.7) ? tolerance::kConvexMargin : random.scale(1e-4, 5e-3);
    expect_as_all_pairs(mesh, {start, end}, radius, faces_around(start, 30, random), touched);
  }
  EXPECT_GT(touched, 1000);
}

/// A sheet of 2 * side * side triangles in the plane z = 0, 0.2 m wide.
ToolMesh flat_mesh(int side) {
  ToolMesh mesh = wavy_mesh(side, 1.0);
  for (Vector3d& vertex : mesh.vertices) vertex.z() = 0.0;
  return mesh;
}

/// The depth of a tree below a node. Counts the leaves.
int depth(const ToolSurface& surface, std::uint32_t index, std::size_t& leaves) {
  const ToolSurface::Node& node = surface.nodes()[index];
  if (node.second == 0) {
    ++leaves;
    return 1;
  }
  return 1 + std::max(depth(surface, index + 1, leaves), depth(surface, node.second, leaves));
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
    ToolMesh mesh = flat_mesh(16);
    for (Vector3d& vertex : mesh.vertices) vertex = pose * vertex;
    const ToolSurface surface = mesh.surface();
    for (const ToolSurface::Node& node : surface.nodes()) {
      EXPECT_LE(node.box.half_size.minCoeff(), 1e-9);
    }
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
  ToolMesh wrong = good;
  wrong.faces[3][1] = 15;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const struct {
    Reason reason;
    const char* word;
    ToolMesh mesh;
  } cases[] = {
      {Reason::kNoTriangles, "no triangle", {good.vertices, {}}},
      {Reason::kNoTriangles, "no triangle", {}},
      {Reason::kNotFinite, "vertex 4", with_vertex(4, {0.0, nan, 0.0})},
      {Reason::kNotFinite, "vertex 2", with_vertex(2, {0.0, 0.0, -INFINITY})},
      {Reason::kTooFar, "vertex 3", with_vertex(3, {1.01 * tolerance::kFarthest, 0.0, 0.0})},
      {Reason::kIndex, "face 3 names vertex 15 of 15", wrong},
      {Reason::kIndex, "face 0", {{}, {FaceIndices{0, 1, 2}}}},
  };
  for (const auto& c : cases) {
    try {
      c.mesh.surface();
      ADD_FAILURE() << "was accepted: " << c.word;
    } catch (const MeshError& error) {
      EXPECT_EQ(error.reason(), c.reason) << error.what();
      EXPECT_NE(std::string(error.what()).find(c.word), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace organ_collision
