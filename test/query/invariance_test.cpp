// What must not change the contacts: how the motion is divided into legs, the order of faces and of
// a tool's triangles, the frame, the other links, the picker, and the magnitude of the numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

constexpr QueryMode kModes[] = {QueryMode::kStatic, QueryMode::kSwept, QueryMode::kPaperStatic,
                                QueryMode::kPaperSwept, QueryMode::kPaperNaive};

class InvarianceWith : public CollisionQueryWith {};

TEST_P(InvarianceWith, ShaftAndLinksAreNumberedAndIndependent) {
  Random random(5);
  for (int i = 0; i < 40; ++i) {
    const LinkScene scene(true, random);
    CollisionRequest together = scene.request, shaft = scene.request, alone = scene.request;
    together.radius = shaft.radius = 4e-3;
    shaft.links = nullptr;
    std::vector<FaceContact> expected = contacts(shaft);
    alone.radius = 0.0;
    for (std::uint32_t link = 0; link < scene.links.size(); ++link) {
      const std::vector<Link> its_links = {scene.links[link]};
      alone.links = &its_links;
      for (std::size_t k = 0; k < alone.path.size(); ++k) {
        alone.path[k].links = {scene.request.path[k].links[link]};
      }
      for (FaceContact contact : contacts(alone)) {
        EXPECT_EQ(contact.shaft, 0.0);
        contact.link = link + 1;
        expected.push_back(contact);
      }
    }
    std::sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) {
      return std::tie(a.face, a.link) < std::tie(b.face, b.link);
    });
    expect_same(contacts(together), expected, 0.0);
  }
}

TEST_P(InvarianceWith, StaticIsSweptWithoutMotion) {
  Random random(7);
  for (int i = 0; i < 40; ++i) {
    LinkScene scene(true, random);
    ToolPath& path = scene.request.path;
    scene.request.organ_before = nullptr;
    scene.request.mode = QueryMode::kStatic;
    const std::vector<FaceContact> expected = contacts(scene.request);
    scene.request.mode = QueryMode::kSwept;
    path.erase(path.begin(), path.end() - 1);
    expect_same(contacts(scene.request), expected, 0.0);
    path.push_back(path.back());
    path.front().fraction = 0.0;
    expect_same(contacts(scene.request), expected, 0.0);
  }
}

TEST_P(InvarianceWith, MotionSplitInTwoFindsTheUnion) {
  Random random(8);
  std::size_t found = 0;
  for (int i = 0; i < 60 && !HasFailure(); ++i) {
    LinkScene scene(false, random);
    ToolPath& path = scene.request.path;
    path.resize(2);
    path[1].fraction = 1.0;
    const std::vector<FaceContact> whole = contacts(scene.request);
    const double time = random.uniform(0.1, 0.9);
    ToolWaypoint between{time, ShaftMotion{path[0].axis, path[1].axis}.at(time)};
    for (std::size_t link = 0; link < scene.links.size(); ++link) {
      between.links.push_back(RigidMotion(path[0].links[link], path[1].links[link]).at(time));
    }
    path.insert(path.begin() + 1, between);
    expect_same_touches(contacts(scene.request), whole, 1e-5);
    found += whole.size();
  }
  EXPECT_GT(found, 300U);
}

TEST_P(InvarianceWith, OrderOfFacesAndVerticesOnlyRenumbers) {
  Random random(9);
  for (int i = 0; i < 40; ++i) {
    LinkScene scene(true, random);
    scene.request.organ_before = nullptr;
    const std::vector<FaceContact> expected = contacts(scene.request);
    std::mt19937 engine(static_cast<unsigned>(i));
    std::vector<std::uint32_t> vertex_to(scene.soup.vertices.size() / 3),
        face_from(scene.organ.face_count());
    std::iota(vertex_to.begin(), vertex_to.end(), 0U);
    std::iota(face_from.begin(), face_from.end(), 0U);
    std::shuffle(vertex_to.begin(), vertex_to.end(), engine);
    std::shuffle(face_from.begin(), face_from.end(), engine);
    Soup other = scene.soup;
    for (std::size_t v = 0; v < vertex_to.size(); ++v) {
      std::copy_n(&scene.soup.vertices[3 * v], 3, &other.vertices[3 * vertex_to[v]]);
    }
    for (std::size_t k = 0; k < other.triangles.size(); ++k) {
      other.triangles[k] = vertex_to[scene.soup.triangles[3 * face_from[k / 3] + k % 3]];
    }
    const TriangleMesh reordered = mesh(other);
    scene.request.organ = &reordered;
    std::vector<FaceContact> found = contacts(scene.request);
    for (FaceContact& contact : found) contact.face = face_from[contact.face];
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      return std::tie(a.face, a.link) < std::tie(b.face, b.link);
    });
    expect_same(found, expected, 0.0);
  }
}

// Several of the scattered triangles touch or pierce the same face. Some occur twice.
TEST_P(InvarianceWith, OrderOfAToolsTrianglesChangesNothing) {
  Random random(14);
  std::size_t found = 0;
  for (int i = 0; i < 40 && !HasFailure(); ++i) {
    LinkScene scene(false, random);
    scene.remove_shaft();
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

// Meshes that were created separately do not share their clusters.
TEST_P(InvarianceWith, ShapesNeedNotShareTheirClusters) {
  Random random(23);
  for (int i = 0; i < 20 && !HasFailure(); ++i) {
    const Soup soup = scattered_faces(400, random);
    const Soup before = changed(soup, Change::kShakes, random);
    const TriangleMesh organ = mesh(soup), alone = mesh(before);
    TriangleMesh sharing = organ;
    sharing.move_vertices(before.vertices);
    CollisionRequest request = swept(organ, random_path(true, random), 0.005);
    request.organ_before = &alone;
    const std::vector<FaceContact> expected = contacts(request);
    request.organ_before = &sharing;
    expect_same(contacts(request), expected, 0.0);
  }
}

/// Rounds coordinates so that sums, and products with small powers of two, are exact.
Vector3d on_lattice(const Vector3d& p) { return (p * 4096.0).array().round() / 4096.0; }

TEST_P(InvarianceWith, TranslationRotationAndScalingCommute) {
  Random random(6);
  Eigen::Matrix3d rotation;  // about (1, 1, 1), without rounding
  rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  for (int i = 0; i < 30; ++i) {
    Soup soup = scattered_faces(100, random);
    for (float& x : soup.vertices) x = std::round(x * 4096.0F) / 4096.0F;
    ToolPath path = random_path(true, random);
    for (ToolWaypoint& waypoint : path) {
      waypoint.axis = {on_lattice(waypoint.axis.trocar), on_lattice(waypoint.axis.tip)};
    }
    const TriangleMesh organ = mesh(soup);
    std::vector<FaceContact> expected = contacts(swept(organ, path, 0.005));

    const double scale = std::ldexp(1.0, random.integer(-3, 3));
    const Vector3d shift =
        scale * Vector3d(random.integer(-8, 8), random.integer(-8, 8), random.integer(-8, 8));
    const auto map = [&](const Vector3d& p) { return Vector3d(scale * (rotation * p) + shift); };
    for (std::size_t v = 0; v < soup.vertices.size(); v += 3) {
      Eigen::Map<Eigen::Vector3f> vertex(&soup.vertices[v]);
      vertex = map(vertex.cast<double>()).cast<float>();
    }
    for (ToolWaypoint& waypoint : path) {
      waypoint.axis = {map(waypoint.axis.trocar), map(waypoint.axis.tip)};
    }
    for (FaceContact& contact : expected) {
      contact.point = map(contact.point);
      contact.end_point = map(contact.end_point);
      contact.normal = rotation * contact.normal;
      contact.depth *= scale;
    }
    const TriangleMesh other = mesh(soup);
    expect_same(contacts(swept(other, path, 0.005 * scale)), expected, 1e-6);
  }
}

constexpr double kTiniest = 1e-300;  // [m]

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
  Soup soup;
  Vector3d amid = Vector3d::Zero();
  for (std::uint32_t i = 0; i < 90; ++i) {
    if (i % 3 == 0) amid = path[random.integer(0, 1)].axis.at(random.uniform(0.0, 1.0));
    const Vector3d vertex = within_reach(amid + size * random.direction());
    for (int k = 0; k < 3; ++k) soup.vertices.push_back(static_cast<float>(vertex[k]));
    soup.triangles.push_back(i);
  }
  return mesh(soup);
}

bool is_finite(const FaceContact& c) {
  return std::isfinite(c.fraction) && c.point.allFinite() && c.normal.allFinite() &&
         c.barycentric.allFinite() && std::isfinite(c.shaft) && std::isfinite(c.depth) &&
         c.end_point.allFinite() && std::isfinite(c.view_min) && std::isfinite(c.view_max);
}

TEST_P(InvarianceWith, AnswersOfAllMagnitudesAreFiniteOrRefused) {
  Random random(1);
  std::size_t answered = 0, refused = 0, found = 0;
  for (std::size_t i = 0; i < 3000 && !HasFailure(); ++i) {
    const Vector3d trocar = random.chance(0.7) ? Vector3d(random.point(0.3))
                                               : Vector3d(random.point(tolerance::kFarthest));
    const double length = some_size(random), step = some_size(random);
    const Vector3d tip = within_reach(trocar + length * random.direction());
    const ToolPath path = {{0.0, {trocar, tip}},
                           {1.0, {trocar, within_reach(tip + step * random.direction())}}};
    const TriangleMesh organ = faces_about(path, some_size(random), random);
    CollisionRequest request = swept(organ, path, some_size(random));
    request.mode = kModes[i % std::size(kModes)];
    const bool is_paper = is_paper_mode(request.mode);
    request.regions = random.chance(0.3) && !is_paper;
    try {
      query_.evaluate(request, result_);
      ++answered;
      found += result_.contacts.size();
    } catch (const std::invalid_argument& error) {
      ++refused;
      EXPECT_TRUE(is_paper) << "only the paper's volumes have limits: " << error.what();
    }
    const double longest = std::max(length, (path[1].axis.tip - trocar).norm());
    for (const FaceContact& contact : result_.contacts) {
      EXPECT_TRUE(is_finite(contact));
      if (!is_paper) continue;
      EXPECT_GE(contact.view_min, 0.0);
      EXPECT_LE(contact.view_min, contact.view_max);
      EXPECT_LE(contact.view_max, longest * (1.0 + 1e-6));
    }
    for (const Region& region : result_.regions) {
      for (const Vector3d& corner : region) EXPECT_TRUE(corner.allFinite());
    }
    if (HasFailure()) {
      ADD_FAILURE() << "mode " << i % 5 << ", radius " << request.radius << ", length " << length
                    << ", step " << step << ", trocar " << trocar.transpose();
    }
  }
  EXPECT_GT(answered, 1500U);
  EXPECT_GT(refused, 300U);
  EXPECT_GT(found, 5000U);
}

INSTANTIATE_TEST_SUITE_P(Pickers, InvarianceWith, testing::ValuesIn(kPickers));

TEST(Invariance, AnswersDoNotDependOnThePicker) {
  CollisionQuery feedback(PickerKind::kFeedback), select(PickerKind::kSelect);
  const TriangleMesh organ = mesh(liver());
  Random random(9);
  for (int i = 0; i < 50; ++i) {
    CollisionRequest request = swept(organ, random_path(false, random), random.scale(0.5e-3, 0.01));
    for (const QueryMode mode : kModes) {
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
