#include "geometry/distance/surface_touch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <vector>

#include "organ_collision/geometry/tolerances.hpp"
#include "test/geometry/tool/tool_meshes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

/// As SurfaceTouches::find(), without a budget.
void find_touches(const ToolSurface& surface, const RigidMotion& motion, double radius,
                  std::vector<FaceTouch>& faces) {
  WorkBudget unlimited = WorkBudget::unlimited();
  SurfaceTouches().find(surface, motion, radius, unlimited, faces);
}

/// The first touch of one face, from every triangle alone, without boxes.
std::optional<FirstTouch> by_all_pairs(const ToolSurface& surface, const RigidMotion& motion,
                                       double radius, const FaceMotion& face) {
  std::optional<FirstTouch> first;
  for (std::size_t i = 0; i < surface.faces().size(); ++i) {
    const ConvexCore core(surface.triangle(i));
    const auto touch = first_touch(CoreMotion(core, motion), face, radius);
    if (touch && (!first || touch->time < first->time)) first = touch;
  }
  return first;
}

/// A touch left from an earlier query.
const FirstTouch kEarlier{0.0, ClosestPoints{}};

/// Faces of an organ around a tool, some at rest and some moving.
std::vector<FaceTouch> faces_around(const Eigen::Isometry3d& pose, std::uint32_t count,
                                    Random& random) {
  std::vector<FaceTouch> faces;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vector3d center = pose * random.point(0.05);
    const double size = random.scale(1e-3, 0.05);
    FaceTouch face{100 + i, {}, {}};
    for (Vector3d& corner : face.motion.end) corner = center + size * random.direction();
    face.motion.start = face.motion.end;
    if (random.chance(0.5)) {
      for (Vector3d& corner : face.motion.start) {
        corner += random.scale(1e-5, 0.02) * random.direction();
      }
    }
    if (random.chance(0.3)) face.first = kEarlier;
    faces.push_back(face);
  }
  return faces;
}

void expect_as_all_pairs(const ToolSurface& surface, const RigidMotion& motion, double radius,
                         std::vector<FaceTouch> faces, int& touched) {
  const std::vector<FaceTouch> asked = faces;
  find_touches(surface, motion, radius, faces);
  ASSERT_EQ(faces.size(), asked.size());
  std::sort(faces.begin(), faces.end(),
            [](const auto& a, const auto& b) { return a.face < b.face; });
  for (std::size_t i = 0; i < faces.size(); ++i) {
    ASSERT_EQ(faces[i].face, asked[i].face);
    EXPECT_EQ(faces[i].motion.start, asked[i].motion.start);
    const auto expected = by_all_pairs(surface, motion, radius, asked[i].motion);
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
    expect_as_all_pairs(mesh.surface(), {start, end}, radius, faces_around(start, 30, random),
                        touched);
  }
  EXPECT_GT(touched, 1000);
}

// A mesh is a surface, so it does not touch the faces that it encloses.
TEST(SurfaceTouch, IsNoneInsideAClosedMesh) {
  Random random(2);
  const Eigen::Isometry3d pose = oracle::random_pose(0.1, random);
  const ToolSurface surface = box_mesh(Eigen::Isometry3d::Identity(), {0.1, 0.1, 0.1}).surface();
  const RigidMotion motion(pose, pose);
  const auto face = [&](double x) {
    const Triangle corners = {pose * Vector3d(x, 0.0, 0.0), pose * Vector3d(x, 0.01, 0.0),
                              pose * Vector3d(x, 0.0, 0.01)};
    return FaceTouch{0, {corners, corners}, {}};
  };
  std::vector<FaceTouch> faces = {face(0.0)};
  find_touches(surface, motion, tolerance::kConvexMargin, faces);
  EXPECT_FALSE(faces[0].first);
  faces = {face(0.05)};
  find_touches(surface, motion, tolerance::kConvexMargin, faces);
  EXPECT_TRUE(faces[0].first);
}

/// A triangle that pierces the plane z = 0 at x, one that is 5e-9 m above the plane at y, and one
/// far away.
ToolMesh piercing_and_grazing(double x, double y) {
  ToolMesh mesh;
  mesh.vertices = {{x, 0.0, 0.01},      {x, 0.002, 0.01},       {x, 0.001, -0.01},
                   {y, 0.0, 5e-9},      {y + 0.002, 0.0, 5e-9}, {y, 0.002, 5e-9},
                   {y + 0.1, 0.0, 0.1}, {y + 0.1, 0.002, 0.1},  {y + 0.1, 0.001, 0.1}};
  mesh.faces = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  return mesh;
}

// Two triangles touch when the leg begins. The result does not depend on which comes first.
TEST(SurfaceTouch, OfTouchesAtTheSameTimeIsTheNearest) {
  Random random(3);
  const Triangle corners = {Vector3d(-0.1, -0.1, 0.0), Vector3d(0.2, -0.1, 0.0),
                            Vector3d(-0.1, 0.2, 0.0)};
  for (int i = 0; i < 200; ++i) {
    ToolMesh mesh = piercing_and_grazing(random.uniform(-0.01, 0.02), random.uniform(-0.01, 0.02));
    std::shuffle(mesh.faces.begin(), mesh.faces.end(), std::mt19937(static_cast<unsigned>(i)));
    Eigen::Isometry3d end = Eigen::Isometry3d::Identity();
    if (random.chance(0.5)) end.translation() = 0.01 * random.direction();
    const RigidMotion motion(Eigen::Isometry3d::Identity(), end);
    std::vector<FaceTouch> faces = {{0, {corners, corners}, {}}};
    find_touches(mesh.surface(), motion, tolerance::kConvexMargin, faces);
    ASSERT_TRUE(faces[0].first);
    EXPECT_EQ(faces[0].first->time, 0.0);
    EXPECT_LE(faces[0].first->closest.distance, tolerance::kTie);
  }
}

/// A flat square of 2 * side * side triangles in the plane z = 0, 0.1 m wide.
ToolMesh flat_mesh(std::uint32_t side) {
  ToolMesh mesh;
  for (std::uint32_t row = 0; row <= side; ++row) {
    for (std::uint32_t column = 0; column <= side; ++column) {
      mesh.vertices.emplace_back(0.1 * column / side, 0.1 * row / side, 0.0);
    }
  }
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      const std::uint32_t corner = row * (side + 1) + column;
      mesh.faces.push_back({corner, corner + 1, corner + side + 1});
      mesh.faces.push_back({corner + 1, corner + side + 2, corner + side + 1});
    }
  }
  return mesh;
}

// Every triangle comes within the convex margin of every face at the same time, and none pierces
// it: the tree of boxes, which are loose because the tool turns, rules out none of the million
// pairs.
TEST(SurfaceTouch, DescendsNoFurtherOnceTheBudgetIsUsedUp) {
  const auto face_at = [](double height) {
    return Triangle{Vector3d(-0.1, -0.1, height), Vector3d(0.3, -0.1, height),
                    Vector3d(-0.1, 0.3, height)};
  };
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d turned = pose;
  turned.rotate(Eigen::AngleAxisd(0.01, Vector3d::UnitZ()));
  std::vector<FaceTouch> faces(200, {0, {face_at(1e-3), face_at(5e-9)}, {}});
  WorkBudget budget;
  SurfaceTouches().find(flat_mesh(50).surface(), RigidMotion(pose, turned),
                        tolerance::kConvexMargin, budget, faces);
  EXPECT_TRUE(budget.is_used_up());
  budget.add_pairs(WorkBudget::kLeastPairs + 10'000);
  EXPECT_FALSE(budget.is_used_up()) << "a tenth of the budget did not suffice to end the search";
  for (const FaceTouch& face : faces) {
    ASSERT_TRUE(face.first);
    EXPECT_FALSE(face.first->is_resolved);
  }
}

}  // namespace
}  // namespace organ_collision
