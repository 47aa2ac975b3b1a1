// What must not change an answer: how the motion is divided into legs, the order of faces, the
// frame, the picker.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "organ_collision/query/collision_query.hpp"
#include "scenes.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

TEST_P(CollisionInvarianceWith, StaticIsSweptWithoutMotion) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const TriangleMesh organ = mesh(scattered_faces(100, random));
    const ShaftAxis axis = random_axis(random);
    CollisionRequest request = swept(organ, {{0.0, axis}, {1.0, axis}}, 5e-3);
    const std::vector<FaceContact> held = contacts(request);
    request.mode = QueryMode::kStatic;
    expect_same(contacts(request), held, 0.0);
    request.path = {{0.0, random_axis(random)}, {1.0, axis}};
    expect_same(contacts(request), held, 0.0);
    request.path = {{0.0, axis}};
    expect_same(contacts(request), held, 0.0);
  }
}

TEST_P(CollisionInvarianceWith, MotionSplitInTwoFindsTheUnion) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const Soup soup = scattered_faces(100, random);
    const TriangleMesh organ = mesh(soup), before = mesh(shaken(soup, 0.01, random));
    const ShaftMotion motion{random_axis(random), random_axis(random)};
    const double time = random.uniform(0.1, 0.9);
    CollisionRequest request = swept(organ, {{0.0, motion.start}, {1.0, motion.end}}, 5e-3);
    if (random.chance(0.5)) request.organ_before = &before;
    const std::vector<FaceContact> whole = contacts(request);
    request.path.insert(request.path.begin() + 1, {time, motion.at(time)});
    expect_same(contacts(request), whole, 1e-6);
  }
}

TEST_P(CollisionInvarianceWith, OrderOfFacesAndVerticesOnlyRenumbers) {
  Random random(5);
  for (int i = 0; i < 30; ++i) {
    const Soup soup = scattered_faces(100, random);
    const std::size_t vertices = soup.vertices.size() / 3, faces = soup.triangles.size() / 3;
    std::vector<std::uint32_t> vertex_to(vertices), face_from(faces);
    std::iota(vertex_to.begin(), vertex_to.end(), 0U);
    std::iota(face_from.begin(), face_from.end(), 0U);
    std::mt19937 engine(i);
    std::shuffle(vertex_to.begin(), vertex_to.end(), engine);
    std::shuffle(face_from.begin(), face_from.end(), engine);
    Soup other = soup;
    for (std::size_t v = 0; v < vertices; ++v)
      for (int k = 0; k < 3; ++k) other.vertices[3 * vertex_to[v] + k] = soup.vertices[3 * v + k];
    for (std::size_t f = 0; f < faces; ++f)
      for (int k = 0; k < 3; ++k)
        other.triangles[3 * f + k] = vertex_to[soup.triangles[3 * face_from[f] + k]];

    const TriangleMesh organ = mesh(soup), shuffled = mesh(other);
    const ToolPath path = random_path(true, random);
    const std::vector<FaceContact> expected = contacts(swept(organ, path, 5e-3));
    std::vector<FaceContact> found = contacts(swept(shuffled, path, 5e-3));
    for (FaceContact& contact : found) contact.face = face_from[contact.face];
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.face < b.face; });
    expect_same(found, expected, 0.0);
  }
}

/// Rounds coordinates so that sums, and products with small powers of two, are exact.
Vector3d on_lattice(const Vector3d& p) { return (p * 4096.0).array().round() / 4096.0; }

TEST_P(CollisionInvarianceWith, TranslationRotationAndScalingCommute) {
  Random random(6);
  Eigen::Matrix3d rotation;  // about (1, 1, 1), without rounding
  rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  for (int i = 0; i < 30; ++i) {
    Soup soup = scattered_faces(100, random);
    for (float& x : soup.vertices) x = std::round(x * 4096.0F) / 4096.0F;
    ToolPath path = random_path(true, random);
    for (ToolWaypoint& waypoint : path)
      waypoint.axis = {on_lattice(waypoint.axis.trocar), on_lattice(waypoint.axis.tip)};
    const TriangleMesh organ = mesh(soup);
    const std::vector<FaceContact> expected = contacts(swept(organ, path, 0.005));

    const double scale = std::ldexp(1.0, random.integer(-3, 3));
    const Vector3d shift =
        scale * Vector3d(random.integer(-8, 8), random.integer(-8, 8), random.integer(-8, 8));
    const auto map = [&](const Vector3d& p) { return Vector3d(scale * (rotation * p) + shift); };
    Soup moved = soup;
    for (std::size_t v = 0; v < soup.vertices.size(); v += 3) {
      const Vector3d p = map({soup.vertices[v], soup.vertices[v + 1], soup.vertices[v + 2]});
      for (int k = 0; k < 3; ++k) moved.vertices[v + k] = static_cast<float>(p[k]);
    }
    for (ToolWaypoint& waypoint : path)
      waypoint.axis = {map(waypoint.axis.trocar), map(waypoint.axis.tip)};
    const TriangleMesh other = mesh(moved);
    const std::vector<FaceContact> found = contacts(swept(other, path, 0.005 * scale));

    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t j = 0; j < found.size(); ++j) {
      FaceContact contact = expected[j];
      contact.point = map(contact.point);
      contact.end_point = map(contact.end_point);
      contact.normal = rotation * contact.normal;
      contact.depth *= scale;
      expect_same(found[j], contact, 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Pickers, CollisionInvarianceWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

TEST(CollisionQuery, AnswerDoesNotDependOnThePicker) {
  CollisionQuery feedback(PickerKind::kFeedback), select(PickerKind::kSelect);
  const TriangleMesh organ = mesh(liver());
  Random random(9);
  for (int i = 0; i < 50; ++i) {
    CollisionRequest request = swept(organ, random_path(false, random), random.scale(0.5e-3, 0.01));
    for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept, QueryMode::kPaperStatic,
                                 QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
      request.mode = mode;
      CollisionResult one, other;
      feedback.evaluate(request, one);
      select.evaluate(request, other);
      expect_same(one.contacts, other.contacts, 0.0);
    }
  }
}

}  // namespace
}  // namespace organ_collision
