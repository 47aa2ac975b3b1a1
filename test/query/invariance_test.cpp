// What must not change the contacts: the order of faces, of vertices and of a tool's triangles, and
// the magnitude of the numbers.
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
    GridSurface other = scene.soup;
    for (std::size_t v = 0; v < vertex_to.size(); ++v) {
      std::copy_n(&scene.soup.vertices[3 * v], 3, &other.vertices[3 * vertex_to[v]]);
    }
    for (std::size_t k = 0; k < face_from.size(); ++k) {
      other.faces[k] = scene.soup.faces[face_from[k]];
      for (std::uint32_t& corner : other.faces[k]) corner = vertex_to[corner];
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

// What is true of links that turn is true of a shaft that a body carries.
TEST_P(InvarianceWith, AShaftThatABodyCarriesMovesAsALinkOfItsShape) {
  Random random(15);
  std::size_t found = 0, by_arc_alone = 0;
  for (int i = 0; i < 150 && !HasFailure(); ++i) {
    LinkScene scene(false, random);
    scene.remove_links(random);
    const double radius = scene.request.radius;
    const ShaftAxis shape{random.point(0.05), Vector3d(0.0, 0.0, 0.15) + random.point(0.05)};
    const Eigen::Isometry3d from = oracle::random_pose(0.1, random);
    Eigen::Isometry3d to = from;
    to.linear() *= oracle::random_turn(random.uniform(0.01, 3.0), random);
    to.translation() += random.scale(1e-5, 0.05) * random.direction();

    CollisionRequest& carried = scene.request;
    carried.path = {{0.0, {from * shape.trocar, from * shape.tip}},
                    {1.0, {to * shape.trocar, to * shape.tip}}};
    const std::vector<FaceContact> straight = contacts(carried);
    const std::vector<Eigen::Isometry3d> start = {from}, end = {to};
    const ChainMotion body{std::make_shared<JointChain>(start, end)};
    carried.path[1].arcs = {ShaftArc(body, shape.trocar), ShaftArc(body, shape.tip)};
    carried.margin = 0.05;
    const std::vector<FaceContact> of_shaft = contacts(carried);
    const ToolClearance clearance = result_.clearance;

    LinkPart capsule = LinkPart::sphere(shape.at(0.5), radius);
    capsule.core.points[0] = shape.trocar;
    capsule.core.points[1] = shape.tip;
    capsule.core.count = 2;
    capsule.bounds.half_size = (0.5 * (shape.tip - shape.trocar)).cwiseAbs();
    scene.links = {{"capsule", {capsule}}};
    CollisionRequest linked = carried;
    linked.radius = 0.0;
    linked.links = &scene.links;
    linked.path = {{0.0, kNoShaft, {from}}, {1.0, kNoShaft, {to}}};
    const std::vector<FaceContact> of_link = contacts(linked);

    ASSERT_EQ(of_shaft.size(), of_link.size()) << "scene " << i;
    for (std::size_t k = 0; k < of_shaft.size(); ++k) {
      EXPECT_EQ(of_shaft[k].face, of_link[k].face);
      EXPECT_NEAR(of_shaft[k].fraction, of_link[k].fraction, 1e-6);
      EXPECT_EQ(of_shaft[k].touching, of_link[k].touching);
    }
    const ToolClearance& of_axis = result_.clearance;  // Only shafts and balls have a radius.
    if (of_axis.state == ClearanceState::kKnown) {
      EXPECT_NEAR(clearance.distance, of_axis.distance - radius, kExact);
      if (of_shaft.empty()) {
        EXPECT_NEAR(clearance.least, of_axis.least - radius, kMoving);
      }
    }
    found += of_shaft.size();
    by_arc_alone += of_shaft.size() != straight.size();
  }
  EXPECT_GT(found, 500U);
  EXPECT_GT(by_arc_alone, 50U) << "arcs must matter";
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
  std::vector<Triangle> faces(30);
  for (Triangle& face : faces) {
    const Vector3d amid = path[random.integer(0, 1)].axis.at(random.uniform(0.0, 1.0));
    for (Vector3d& corner : face) corner = within_reach(amid + size * random.direction());
  }
  return oracle::mesh_of(faces);
}

bool is_finite(const FaceContact& c) {
  return std::isfinite(c.fraction) && c.point.allFinite() && c.normal.allFinite() &&
         c.barycentric.allFinite() && std::isfinite(c.shaft) && std::isfinite(c.depth) &&
         c.on_organ.allFinite();
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
    request.regions = random.chance(0.3);
    try {
      query_.evaluate(request, result_);
      ++answered;
      EXPECT_EQ(result_.regions.size(), request.regions ? result_.contacts.size() : 0U);
      found += result_.contacts.size();
    } catch (const std::invalid_argument& error) {
      ++refused;
      EXPECT_TRUE(is_paper) << "only the paper's volumes have limits: " << error.what();
    }
    const double longest = std::max(length, (path[1].axis.tip - trocar).norm());
    for (const FaceContact& contact : result_.contacts) {
      EXPECT_TRUE(is_finite(contact));
    }
    EXPECT_EQ(result_.view_ranges.size(), is_paper ? result_.contacts.size() : 0U);
    for (const ViewRange& range : result_.view_ranges) {
      EXPECT_GE(range.min, 0.0);
      EXPECT_LE(range.min, range.max);
      EXPECT_LE(range.max, longest * (1.0 + 1e-6));
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

INSTANTIATE_TEST_SUITE_P(Pickers, InvarianceWith, testing::ValuesIn(picker_kinds()));

}  // namespace
}  // namespace organ_collision
