#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "scenes.hpp"
#include "test/geometry/tool/tool_meshes.hpp"
#include "test/proof/trials.hpp"

// What must not change an answer: how the motion is divided into legs, the order of faces, the
// frame, the picker.

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

// What must not change the contacts of links: other links, the shaft, how the motion is divided
// into legs, the order of faces.

namespace organ_collision {
namespace {

using oracle::Random;

using LinkInvarianceWith = CollisionQueryWith;

TEST_P(LinkInvarianceWith, ShaftAndLinksAreNumberedAndIndependent) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const LinkScene scene(true, random);
    CollisionRequest together = scene.request, shaft = scene.request, links = scene.request;
    together.radius = shaft.radius = 4e-3;
    shaft.links = nullptr;
    links.radius = 0.0;
    std::vector<FaceContact> expected = contacts(shaft);
    for (FaceContact contact : contacts(links)) {
      EXPECT_EQ(contact.shaft, 0.0);
      ++contact.link;
      expected.push_back(contact);
    }
    std::sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) {
      return std::tie(a.face, a.link) < std::tie(b.face, b.link);
    });
    const std::vector<FaceContact> found = contacts(together);
    expect_same(found, expected, 0.0);
    expect_same_links(found, expected);
  }
}

TEST_P(LinkInvarianceWith, LinksAreIndependentOfEachOther) {
  Random random(6);
  for (int i = 0; i < 30; ++i) {
    LinkScene scene(true, random);
    scene.request.radius = 0.0;
    const std::vector<FaceContact> together = contacts(scene.request);
    for (std::uint32_t link = 0; link < scene.links.size(); ++link) {
      const std::vector<Link> alone = {scene.links[link]};
      CollisionRequest request = scene.request;
      request.links = &alone;
      for (ToolWaypoint& waypoint : request.path) waypoint.links = {waypoint.links[link]};
      std::vector<FaceContact> expected;
      for (const FaceContact& contact : together) {
        if (contact.link == link) expected.push_back(contact);
      }
      expect_same(contacts(request), expected, 0.0);
    }
  }
}

TEST_P(LinkInvarianceWith, StaticIsSweptWithoutMotion) {
  Random random(7);
  for (int i = 0; i < 30; ++i) {
    LinkScene scene(true, random);
    scene.request.organ_before = nullptr;
    scene.request.mode = QueryMode::kStatic;
    const std::vector<FaceContact> expected = contacts(scene.request);
    scene.request.mode = QueryMode::kSwept;
    scene.request.path.erase(scene.request.path.begin(), scene.request.path.end() - 1);
    expect_same(contacts(scene.request), expected, 0.0);
    scene.request.path.push_back(scene.request.path.back());
    scene.request.path.front().fraction = 0.0;
    expect_same(contacts(scene.request), expected, 0.0);
  }
}

TEST_P(LinkInvarianceWith, MotionSplitInTwoFindsTheUnion) {
  Random random(8);
  std::size_t found = 0;
  for (int i = 0; i < 60 && !HasFailure(); ++i) {
    LinkScene scene(false, random);
    scene.request.radius = 0.0;
    ToolPath& path = scene.request.path;
    path.resize(2);
    path[1].fraction = 1.0;
    const std::vector<FaceContact> whole = contacts(scene.request);
    ToolWaypoint between{random.uniform(0.1, 0.9), path[0].axis};
    for (std::size_t link = 0; link < scene.links.size(); ++link) {
      const RigidMotion motion(path[0].links[link], path[1].links[link]);
      between.links.push_back(motion.at(between.fraction));
    }
    path.insert(path.begin() + 1, between);
    const std::vector<FaceContact> split = contacts(scene.request);
    ASSERT_EQ(split.size(), whole.size());
    for (std::size_t j = 0; j < whole.size(); ++j) {
      EXPECT_EQ(split[j].face, whole[j].face);
      EXPECT_EQ(split[j].link, whole[j].link);
      EXPECT_NEAR(split[j].fraction, whole[j].fraction, 1e-5);
    }
    found += whole.size();
  }
  EXPECT_GT(found, 300U);
}

TEST_P(LinkInvarianceWith, OrderOfFacesOnlyRenumbers) {
  Random random(9);
  for (int i = 0; i < 30; ++i) {
    LinkScene scene(true, random);
    scene.request.organ_before = nullptr;
    const std::vector<FaceContact> expected = contacts(scene.request);
    std::vector<std::uint32_t> from(scene.organ.face_count());
    std::iota(from.begin(), from.end(), 0U);
    std::shuffle(from.begin(), from.end(), std::mt19937(static_cast<unsigned>(i)));
    Soup other = scene.soup;
    for (std::size_t face = 0; face < from.size(); ++face) {
      std::copy_n(&scene.soup.triangles[3 * from[face]], 3, &other.triangles[3 * face]);
    }
    const TriangleMesh shuffled = mesh(other);
    scene.request.organ = &shuffled;
    std::vector<FaceContact> found = contacts(scene.request);
    for (FaceContact& contact : found) contact.face = from[contact.face];
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      return std::tie(a.face, a.link) < std::tie(b.face, b.link);
    });
    expect_same(found, expected, 0.0);
    expect_same_links(found, expected);
  }
}

// Several of the scattered triangles touch or pierce the same face. Some occur twice.
TEST_P(LinkInvarianceWith, OrderOfAToolsTrianglesChangesNothing) {
  Random random(14);
  std::size_t found = 0;
  for (int i = 0; i < 40 && !HasFailure(); ++i) {
    LinkScene scene(false, random);
    scene.request.radius = 0.0;
    scene.links.resize(1);
    for (ToolWaypoint& waypoint : scene.request.path) waypoint.links.resize(1);
    if (random.chance(0.5)) scene.request.mode = QueryMode::kStatic;
    ToolMesh tool = scattered_mesh(60, random);
    scene.links[0].parts = {LinkPart::mesh(tool.surface())};
    const std::vector<FaceContact> expected = contacts(scene.request);
    found += expected.size();
    for (unsigned order = 0; order < 3; ++order) {
      std::shuffle(tool.faces.begin(), tool.faces.end(), std::mt19937(order));
      scene.links[0].parts = {LinkPart::mesh(tool.surface())};
      expect_same(contacts(scene.request), expected, 0.0);
    }
  }
  EXPECT_GT(found, 300U);
}

INSTANTIATE_TEST_SUITE_P(Pickers, LinkInvarianceWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace

}  // namespace organ_collision

// collision_query.hpp for all legal magnitudes of radius, shaft length, motion and organ.

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

constexpr double kTiniest = 1e-300;  // [m]
constexpr QueryMode kModes[] = {QueryMode::kStatic, QueryMode::kSwept, QueryMode::kPaperStatic,
                                QueryMode::kPaperSwept, QueryMode::kPaperNaive};

/// [m] A size of any magnitude: ordinary sizes, and sizes near the limits of 32-bit and 64-bit
/// numbers.
double some_size(Random& random) {
  const double size[] = {random.scale(1e-3, 0.3), random.scale(1e-12, 1e6),
                         random.scale(1e-50, 1e-12), random.scale(kTiniest, 1e-50), 1e-20};
  return size[random.integer(0, 4)];
}

Vector3d within_reach(const Vector3d& point) {
  return point.cwiseMax(-tolerance::kFarthest).cwiseMin(tolerance::kFarthest);
}

/// Faces of about the given size around the axis at the start or end of a path.
TriangleMesh faces_about(const ToolPath& path, double size, Random& random) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < 30; ++i) {
    const ShaftAxis& axis = path[random.integer(0, 1)].axis;
    const Vector3d amid = axis.at(random.uniform(0.0, 1.0));
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const Vector3d vertex = within_reach(amid + size * random.direction());
      for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(vertex[k]));
      triangles.push_back(3 * i + corner);
    }
  }
  return {vertices, triangles};
}

void expect_finite(const FaceContact& contact) {
  EXPECT_TRUE(std::isfinite(contact.fraction));
  EXPECT_TRUE(contact.point.allFinite());
  EXPECT_TRUE(contact.normal.allFinite());
  EXPECT_TRUE(contact.barycentric.allFinite());
  EXPECT_TRUE(std::isfinite(contact.shaft));
  EXPECT_TRUE(std::isfinite(contact.depth));
  EXPECT_TRUE(contact.end_point.allFinite());
  EXPECT_TRUE(std::isfinite(contact.view_min));
  EXPECT_TRUE(std::isfinite(contact.view_max));
}

/// The depths along the view lie between 0 and the length of the shaft.
void expect_within_view(const FaceContact& contact, const ToolPath& path) {
  double length = 0.0;
  for (const auto& [fraction, axis, links] : path) {
    length = std::max(length, (axis.tip - axis.trocar).norm());
  }
  EXPECT_GE(contact.view_min, 0.0);
  EXPECT_LE(contact.view_min, contact.view_max);
  EXPECT_LE(contact.view_max, length * (1.0 + 1e-6));
}

using MagnitudesWith = CollisionQueryWith;

TEST_P(MagnitudesWith, AnswersAreFiniteOrRefused) {
  Random random(1);
  std::size_t answered = 0, refused = 0, found = 0;
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    const Vector3d trocar = random.chance(0.7) ? Vector3d(random.point(0.3))
                                               : Vector3d(random.point(tolerance::kFarthest));
    const double length = some_size(random), step = some_size(random);
    const Vector3d tip = within_reach(trocar + length * random.direction());
    const ToolPath path = {{0.0, {trocar, tip}},
                           {1.0, {trocar, within_reach(tip + step * random.direction())}}};
    const TriangleMesh organ = faces_about(path, some_size(random), random);
    CollisionRequest request = swept(organ, path, some_size(random));
    request.mode = kModes[i % std::size(kModes)];
    request.regions = random.chance(0.3) && i % 5 < 2;
    try {
      query_.evaluate(request, result_);
      ++answered;
      found += result_.contacts.size();
    } catch (const std::invalid_argument& error) {
      ++refused;
      EXPECT_GE(i % 5, 2) << "only the paper's volumes have limits: " << error.what();
    }
    for (const FaceContact& contact : result_.contacts) {
      expect_finite(contact);
      if (i % 5 >= 2) expect_within_view(contact, path);
    }
    for (const Region& region : result_.regions) {
      for (const Vector3d& corner : region) EXPECT_TRUE(corner.allFinite());
    }
    if (HasFailure()) {
      ADD_FAILURE() << "mode " << i % 5 << ", radius " << request.radius << ", length " << length
                    << ", step " << step << ", trocar " << trocar.transpose() << ", tip "
                    << tip.transpose();
    }
  }
  EXPECT_GT(answered, 1500U);
  EXPECT_GT(refused, 300U);
  EXPECT_GT(found, 5000U);
}

TEST_P(MagnitudesWith, PaperVolumesTooThinForClippingAreRefusedByName) {
  Random random(2);
  const TriangleMesh organ = mesh(liver());
  const Vector3d trocar(0.02, -0.03, 0.25);
  CollisionRequest request = swept(
      organ, {{0.0, {trocar, {0.01, 0.01, 0.035}}}, {1.0, {trocar, {-0.03, 0.01, 0.03}}}}, 1e-20);
  for (const QueryMode mode :
       {QueryMode::kPaperStatic, QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
    request.mode = mode;
    request.radius = 1e-20;
    try {
      query_.evaluate(request, result_);
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("1e-20"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(result_.contacts.empty());
    request.radius = 1e-5;
    EXPECT_NO_THROW(query_.evaluate(request, result_));
  }
}

INSTANTIATE_TEST_SUITE_P(Pickers, MagnitudesWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace

}  // namespace organ_collision
