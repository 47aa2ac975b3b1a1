#include "organ_collision/query/placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "scenes.hpp"
#include "test/closed_surfaces.hpp"
#include "test/proof/exact_sides.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

TriangleMesh mesh_of(const GridSurface& surface) { return {surface.vertices, surface.triangles()}; }

SurfaceTopology topology_of(const GridSurface& surface) {
  return {surface.faces, surface.vertices};
}

CollisionRequest placement_of(const ShaftAxis& axis, const TriangleMesh& organ,
                              const SurfaceTopology* topology) {
  CollisionRequest request;
  request.organ = &organ;
  request.path = resting_path({axis});
  request.radius = 1e-3;
  request.placement = true;
  request.surface_topology = topology;
  return request;
}

struct NamedSurface {
  std::string name;
  GridSurface surface;
};

/// Closed surfaces of many kinds, about 0.2 m large.
std::vector<NamedSurface> closed_surfaces() {
  const GridSurface ball = sphere(6, 9, 0.1), ring = torus(6, 11, 0.1, 0.4);
  const GridSurface cube = grid_cube(4, 0.03125F);
  GridSurface collapsed = sphere(7, 8, 0.1);
  for (const std::uint32_t vertex : {11U, 12U, 20U}) {
    std::copy_n(&collapsed.vertices[3 * 10], 3, &collapsed.vertices[3 * vertex]);
  }
  GridSurface flat = sphere(5, 6, 0.1);
  for (std::size_t i = 2; i < flat.vertices.size(); i += 3) flat.vertices[i] = 0.0F;
  return {{"sphere", ball},
          {"torus", ring},
          {"cube on a grid, with seams", cube},
          {"cavity in a cavity",
           joined(joined(ball, turned_over(sphere(5, 8, 0.08))), sphere(5, 7, 0.05))},
          {"two spheres that touch in a vertex", joined(ball, moved(ball, {0.0F, 0.0F, 0.2F}))},
          {"two cubes that touch in a square", joined(cube, moved(cube, {0.125F, 0.0F, 0.0F}))},
          {"two bodies that intersect", joined(ring, moved(ball, {0.05F, 0.02F, 0.01F}))},
          {"the same body twice", joined(ball, ball)},
          {"a body and its opposite", joined(ball, turned_over(ball))},
          {"inward", turned_over(ring)},
          {"intersects itself", shaken(ring, 0.04F, 7)},
          {"separate triangles", shuffled(unwelded(ring), 5)},
          {"collapsed faces", collapsed},
          {"flat", flat},
          {"far from the origin", moved(ball, {812.0F, -511.0F, 97.0F})}};
}

/// The welded faces, without their mesh.
std::vector<Triangle> triangles(const GridSurface& surface, const SurfaceTopology& topology) {
  const TriangleMesh mesh = mesh_of(surface);
  std::vector<Triangle> faces;
  for (const FaceIndices& face : mesh.faces()) {
    faces.push_back(mesh.triangle(topology.welded(face)));
  }
  return faces;
}

/// A point near or on the surface: in the open, at a corner, on an edge or on a face.
Vector3d some_point(const TriangleMesh& mesh, Random& random) {
  const Eigen::AlignedBox3d box = mesh.box().cast<double>();
  const Triangle face = mesh.triangle(
      static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.face_count()) - 1)));
  switch (random.integer(0, 6)) {
    case 0:
      return face[0];
    case 1:
      return 0.5 * (face[0] + face[1]);
    case 2:
      return 0.5 * face[0] + 0.25 * face[1] + 0.25 * face[2];
    case 3:
      return face[0] + random.scale(1e-12, 1e-3) * random.direction();
    case 4:
      return box.center() + 3.0 * box.sizes().maxCoeff() * random.direction();
    default:
      return box.center() +
             0.6 * random.uniform(0, 1) * box.sizes().maxCoeff() * random.direction();
  }
}

/// Many axes are in special position.
ShaftAxis some_axis(const TriangleMesh& mesh, Random& random) {
  ShaftAxis axis{some_point(mesh, random), some_point(mesh, random)};
  if (random.chance(0.3)) {
    // Goes on past a special point, without rounding where the numbers are short.
    axis.tip = axis.trocar + 2.0 * (axis.tip - axis.trocar);
  }
  if (random.chance(0.2)) {
    for (Eigen::Index i : {0, 1}) axis.tip[(random.integer(0, 2) + i) % 3] = axis.trocar[i];
    axis.tip.x() = axis.trocar.x();  // along a coordinate plane or axis
    if (random.chance(0.5)) axis.tip.y() = axis.trocar.y();
  }
  if (random.chance(0.05)) axis.tip = axis.trocar;  // a ball
  if (random.chance(0.5)) std::swap(axis.trocar, axis.tip);
  return axis;
}

Side expected_side(const std::vector<Triangle>& faces, const Vector3d& point) {
  for (const Triangle& face : faces) {
    if (oracle::is_exactly_on(face, point)) return Side::kOnSurface;
  }
  return oracle::exact_winding(faces, point) != 0 ? Side::kInside : Side::kOutside;
}

double expected_length(const std::vector<oracle::ExactCrossing>& crossings, int winding,
                       double axis_length) {
  double length = 0.0, place = 0.0;
  for (const auto& crossing : crossings) {
    if (winding != 0) length += (crossing.shaft - place) * axis_length;
    place = crossing.shaft;
    winding += crossing.direction;
  }
  return winding != 0 ? length + (1.0 - place) * axis_length : length;
}

/// The faces in the order of the crossings. Faces that lie on each other have no order.
std::vector<std::tuple<int, std::uint32_t>> sorted_faces(const std::vector<AxisCrossing>& found) {
  std::vector<std::tuple<int, std::uint32_t>> faces;
  for (const AxisCrossing& crossing : found) faces.emplace_back(crossing.direction, crossing.face);
  std::sort(faces.begin(), faces.end());
  return faces;
}

class PlacementWith : public CollisionQueryWith {
 protected:
  const AxisPlacement& placement(const ShaftAxis& axis, const TriangleMesh& organ,
                                 const SurfaceTopology* topology) {
    query_.evaluate(placement_of(axis, organ, topology), result_);
    return result_.placement;
  }

  /// Compares with the oracle.
  void expect_exact(const ShaftAxis& axis, const TriangleMesh& organ,
                    const SurfaceTopology& topology, const std::vector<Triangle>& faces) {
    const AxisPlacement& found = placement(axis, organ, &topology);
    EXPECT_EQ(found.trocar, expected_side(faces, axis.trocar));
    EXPECT_EQ(found.tip, expected_side(faces, axis.tip));
    const auto crossings = oracle::exact_crossings(faces, axis);
    ASSERT_EQ(found.crossings.size(), crossings.size());
    const double reach = OrganMotion(organ).extent(Vector3d::Zero());
    const int winding = oracle::exact_winding(faces, axis.trocar);
    int sum = 0;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      const AxisCrossing& crossing = found.crossings[i];
      EXPECT_EQ(crossing.direction, crossings[i].direction) << "crossing " << i;
      EXPECT_NEAR(crossing.shaft, crossings[i].shaft, 1e-13);
      EXPECT_EQ(crossing.vertices, organ.faces()[crossing.face]);
      EXPECT_GE(crossing.barycentric.minCoeff(), 0.0);
      EXPECT_NEAR(crossing.barycentric.sum(), 1.0, 1e-15);
      EXPECT_LE((crossing.point - axis.at(crossing.shaft)).norm(), 1e-14 * reach + 1e-12);
      sum += crossing.direction;
    }
    EXPECT_EQ(winding + sum, oracle::exact_winding(faces, axis.tip)) << "of the oracle";
    EXPECT_TRUE(found.length_known);
    const double length = (axis.tip - axis.trocar).norm();
    EXPECT_NEAR(found.length_inside, expected_length(crossings, winding, length), 1e-12);
  }
};

TEST_P(PlacementWith, AgreesWithTheOracle) {
  Random random(81);
  std::array<int, 4> sides = {};
  int crossings = 0;
  for (const auto& [name, surface] : closed_surfaces()) {
    const TriangleMesh organ = mesh_of(surface);
    const SurfaceTopology topology = topology_of(surface);
    ASSERT_TRUE(topology.is_closed()) << name;
    const std::vector<Triangle> faces = triangles(surface, topology);
    for (int trial = 0; trial < 60; ++trial) {
      SCOPED_TRACE(name + ", trial " + std::to_string(trial));
      expect_exact(some_axis(organ, random), organ, topology, faces);
      if (HasFatalFailure()) return;
      ++sides[static_cast<std::size_t>(result_.placement.tip)];
      crossings += static_cast<int>(result_.placement.crossings.size());
    }
  }
  EXPECT_EQ(sides[0], 0);
  EXPECT_GT(*std::min_element(sides.begin() + 1, sides.end()), 100) << "too few of one side";
  EXPECT_GT(crossings, 500);
}

/// Where a surface does not intersect itself, the axis enters and leaves in turn, in every special
/// position.
TEST_P(PlacementWith, EntersAndLeavesInTurn) {
  Random random(82);
  for (const GridSurface& surface :
       {sphere(6, 9, 0.1), torus(6, 11, 0.1, 0.4), grid_cube(4, 0.03125F)}) {
    const TriangleMesh organ = mesh_of(surface);
    const SurfaceTopology topology = topology_of(surface);
    int crossings = 0;
    for (int trial = 0; trial < 500; ++trial) {
      const auto& found = placement(some_axis(organ, random), organ, &topology);
      for (std::size_t i = 0; i < found.crossings.size(); ++i) {
        const int inside = found.crossings[0].direction > 0 ? 0 : 1;
        ASSERT_EQ(found.crossings[i].direction, (i + inside) % 2 == 0 ? 1 : -1)
            << "trial " << trial;
      }
      crossings += static_cast<int>(found.crossings.size());
    }
    EXPECT_GT(crossings, 300);
  }
}

TEST_P(PlacementWith, TheOrderOfFacesChangesNothing) {
  Random random(83);
  for (const auto& [name, surface] : closed_surfaces()) {
    const TriangleMesh organ = mesh_of(surface);
    const SurfaceTopology topology = topology_of(surface);
    const GridSurface other = with_rotated_corners(shuffled(surface, 17), 18);
    const TriangleMesh same = mesh_of(other);
    const SurfaceTopology same_topology = topology_of(other);
    for (int trial = 0; trial < 60; ++trial) {
      SCOPED_TRACE(name + ", trial " + std::to_string(trial));
      const ShaftAxis axis = some_axis(organ, random);
      const AxisPlacement one = placement(axis, organ, &topology);
      const AxisPlacement& two = placement(axis, same, &same_topology);
      EXPECT_EQ(one.tip, two.tip);
      EXPECT_EQ(one.trocar, two.trocar);
      EXPECT_EQ(one.length_inside, two.length_inside);
      ASSERT_EQ(one.crossings.size(), two.crossings.size());
      for (std::size_t i = 0; i < one.crossings.size(); ++i) {
        EXPECT_EQ(one.crossings[i].shaft, two.crossings[i].shaft);
        EXPECT_EQ(one.crossings[i].direction, two.crossings[i].direction);
        EXPECT_LE((one.crossings[i].point - two.crossings[i].point).norm(), 1e-12);
      }
    }
  }
}

TEST_P(PlacementWith, AReversedAxisCrossesTheSameFacesTheOtherWay) {
  Random random(84);
  for (const auto& [name, surface] : closed_surfaces()) {
    const TriangleMesh organ = mesh_of(surface);
    const SurfaceTopology topology = topology_of(surface);
    for (int trial = 0; trial < 60; ++trial) {
      SCOPED_TRACE(name + ", trial " + std::to_string(trial));
      const ShaftAxis axis = some_axis(organ, random);
      const AxisPlacement one = placement(axis, organ, &topology);
      AxisPlacement back = placement({axis.tip, axis.trocar}, organ, &topology);
      EXPECT_EQ(one.tip, back.trocar);
      EXPECT_EQ(one.trocar, back.tip);
      EXPECT_NEAR(one.length_inside, back.length_inside, 1e-12);
      for (AxisCrossing& crossing : back.crossings) {
        crossing.direction = static_cast<std::int8_t>(-crossing.direction);
      }
      EXPECT_EQ(sorted_faces(one.crossings), sorted_faces(back.crossings));
    }
  }
}

/// The tip of a tool of links alone.
TEST_P(PlacementWith, ATipWithoutAShaft) {
  Random random(85);
  const std::vector<Link> links = {{"jaw", {LinkPart::sphere(Vector3d::Zero(), 0.01)}}};
  for (const auto& [name, surface] : closed_surfaces()) {
    const TriangleMesh organ = mesh_of(surface);
    const SurfaceTopology topology = topology_of(surface);
    const std::vector<Triangle> faces = triangles(surface, topology);
    CollisionRequest request;
    request.organ = &organ;
    request.links = &links;
    request.path =
        resting_path({{Vector3d::Zero(), Vector3d::Zero()}, {Eigen::Isometry3d::Identity()}});
    request.placement = true;
    for (int trial = 0; trial < 30; ++trial) {
      SCOPED_TRACE(name + ", trial " + std::to_string(trial));
      request.surface_topology = &topology;
      request.tip = some_point(organ, random);
      query_.evaluate(request, result_);
      EXPECT_EQ(result_.placement.tip, expected_side(faces, *request.tip));
      EXPECT_EQ(result_.placement.trocar, Side::kUnknown);
      EXPECT_TRUE(result_.placement.crossings.empty());
      EXPECT_FALSE(result_.placement.length_known);
    }
    request.surface_topology = nullptr;
    query_.evaluate(request, result_);
    EXPECT_EQ(result_.placement.tip, Side::kUnknown);
    request.surface_topology = &topology;
    request.tip.reset();
    query_.evaluate(request, result_);
    EXPECT_EQ(result_.placement.tip, Side::kUnknown);
  }
}

TEST_P(PlacementWith, ASphereInClosedForm) {
  Random random(86);
  const GridSurface surface = sphere(60, 90, 0.1);
  const TriangleMesh organ = mesh_of(surface);
  const SurfaceTopology topology = topology_of(surface);
  for (int trial = 0; trial < 200; ++trial) {
    const double distance = random.uniform(0.0, 0.15);  // of the axis from the centre
    const Vector3d along = random.direction(), foot = distance * along.unitOrthogonal();
    const double half = std::sqrt(std::max(0.0, 0.01 - distance * distance));  // of the chord
    const double tip = random.uniform(-0.2, 0.2);
    if (std::abs(distance - 0.1) < 1e-3 || std::abs(std::abs(tip) - half) < 1e-2) continue;
    const auto& found = placement({foot - 0.2 * along, foot + tip * along}, organ, &topology);
    const bool is_inside = std::abs(tip) < half;
    EXPECT_EQ(found.trocar, Side::kOutside);
    EXPECT_EQ(found.tip, is_inside ? Side::kInside : Side::kOutside);
    EXPECT_EQ(found.crossings.size(), tip < -half || half == 0.0 ? 0U : is_inside ? 1U : 2U);
    const double inside = std::clamp(tip, -half, half) + half;
    EXPECT_NEAR(found.length_inside, inside, 5e-3);
  }
}

TEST_P(PlacementWith, AnOpenSurfaceHasCrossingsButNoSides) {
  Random random(87);
  GridSurface surface = torus(6, 11, 0.1, 0.4);
  surface.faces.erase(surface.faces.begin() + 7);
  const TriangleMesh organ = mesh_of(surface);
  const SurfaceTopology topology = topology_of(surface);
  const std::vector<Triangle> faces = triangles(surface, topology);
  for (const SurfaceTopology* const given :
       {&topology, static_cast<const SurfaceTopology*>(nullptr)}) {
    std::size_t crossings = 0;
    for (int trial = 0; trial < 100; ++trial) {
      const ShaftAxis axis = some_axis(organ, random);
      const auto& found = placement(axis, organ, given);
      EXPECT_EQ(found.tip, Side::kUnknown);
      EXPECT_EQ(found.trocar, Side::kUnknown);
      EXPECT_FALSE(found.length_known);
      EXPECT_EQ(found.length_inside, 0.0);
      const auto expected = oracle::exact_crossings(faces, axis);
      ASSERT_EQ(found.crossings.size(), expected.size()) << "trial " << trial;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(found.crossings[i].face, expected[i].face);
        EXPECT_LE((found.crossings[i].barycentric - expected[i].barycentric).norm(), 1e-13);
      }
      crossings += expected.size();
    }
    EXPECT_GT(crossings, 50U);
  }
}

/// Separate triangles whose corners drift apart. Up to the tolerance, the first vertex at each
/// place counts, and no axis slips through.
TEST_P(PlacementWith, SeamsThatOpen) {
  Random random(88);
  const GridSurface soup = shuffled(unwelded(torus(6, 11, 0.1, 0.4)), 9);
  const SurfaceTopology topology = topology_of(soup);
  const GridSurface drifted = shaken(soup, 2.5e-7F, 21);
  const TriangleMesh organ = mesh_of(drifted);
  const std::vector<Triangle> faces = triangles(drifted, topology);
  for (std::size_t trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    ShaftAxis axis = some_axis(organ, random);
    // Aims where three or more separate triangles meet.
    if (trial % 2 == 0)
      axis.tip = axis.trocar + 2.0 * (faces[trial % faces.size()][0] - axis.trocar);
    expect_exact(axis, organ, topology, faces);
    if (HasFatalFailure()) return;
  }

  const TriangleMesh torn = mesh_of(shaken(soup, 2e-6F, 22));
  const std::vector<Triangle> own = [&] {
    std::vector<Triangle> all;
    for (const FaceIndices& face : torn.faces()) all.push_back(torn.triangle(face));
    return all;
  }();
  for (int trial = 0; trial < 100; ++trial) {
    const ShaftAxis axis = some_axis(torn, random);
    const auto& found = placement(axis, torn, &topology);
    EXPECT_EQ(found.tip, Side::kUnknown);
    EXPECT_EQ(found.trocar, Side::kUnknown);
    EXPECT_FALSE(found.length_known);
    EXPECT_EQ(found.crossings.size(), oracle::exact_crossings(own, axis).size());
  }
}

/// Trocars and tips far away, up to the largest legal coordinate, and organs of any size.
TEST_P(PlacementWith, AllMagnitudes) {
  Random random(89);
  for (const float size : {1e-12F, 1e-6F, 1e-3F, 30.0F, 1e4F}) {
    GridSurface surface = torus(6, 11, 0.1, 0.4);
    for (float& coordinate : surface.vertices) coordinate *= size;
    const TriangleMesh organ = mesh_of(surface);
    const SurfaceTopology topology = topology_of(surface);
    const std::vector<Triangle> faces = triangles(surface, topology);
    for (int trial = 0; trial < 40; ++trial) {
      SCOPED_TRACE("size " + std::to_string(size) + ", trial " + std::to_string(trial));
      const Vector3d target = some_point(organ, random);
      ShaftAxis axis{random.scale(1e-3, 5e5) * random.direction(), target};
      if (trial % 2 == 0) axis.tip = 2.0 * target - axis.trocar;
      const auto& found = placement(axis, organ, &topology);
      EXPECT_EQ(found.tip, expected_side(faces, axis.tip));
      EXPECT_EQ(found.trocar, expected_side(faces, axis.trocar));
      const auto expected = oracle::exact_crossings(faces, axis);
      ASSERT_EQ(found.crossings.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_LE((found.crossings[i].barycentric - expected[i].barycentric).norm(), 1e-12);
      }
    }
  }
}

/// The end of the step counts: of the tool and of the organ.
TEST_P(PlacementWith, IsThatAtTheEndOfTheStep) {
  const GridSurface surface = sphere(6, 9, 0.1);
  const TriangleMesh before = mesh_of(moved(surface, {0.3F, 0.0F, 0.0F})), after = mesh_of(surface);
  const SurfaceTopology topology = topology_of(surface);
  CollisionRequest request = placement_of({{0, 0, 0.3}, {0, 0, 0.01}}, after, &topology);
  request.organ_before = &before;
  request.mode = QueryMode::kSwept;
  request.path = {{0.0, {{0.3, 0, 0.3}, {0.3, 0, 0.31}}}, {1.0, request.path[0].axis}};
  query_.evaluate(request, result_);
  EXPECT_EQ(result_.placement.tip, Side::kInside);
  EXPECT_EQ(result_.placement.trocar, Side::kOutside);
  ASSERT_EQ(result_.placement.crossings.size(), 1U);
  EXPECT_EQ(result_.placement.crossings[0].direction, 1);
  EXPECT_NEAR(result_.placement.length_inside, 0.09, 1e-3);
}

TEST_P(PlacementWith, NothingRemainsOfTheLastAnswer) {
  const GridSurface surface = sphere(6, 9, 0.1);
  const TriangleMesh organ = mesh_of(surface);
  const SurfaceTopology topology = topology_of(surface);
  CollisionRequest request = placement_of({{0, 0, 0.3}, {0, 0, 0.01}}, organ, &topology);
  query_.evaluate(request, result_);
  ASSERT_FALSE(result_.placement.crossings.empty());
  request.placement = false;
  query_.evaluate(request, result_);
  EXPECT_EQ(result_.placement.tip, Side::kUnknown);
  EXPECT_EQ(result_.placement.trocar, Side::kUnknown);
  EXPECT_TRUE(result_.placement.crossings.empty());
  EXPECT_FALSE(result_.placement.length_known);
  EXPECT_EQ(result_.placement.length_inside, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Pickers, PlacementWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace
}  // namespace organ_collision
