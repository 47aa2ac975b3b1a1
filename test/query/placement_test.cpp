// collision_query.hpp: the placement where it has less to tell. exactness_proof compares the
// placement of shafts at closed surfaces with exact arithmetic.
#include "organ_collision/query/placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "test/proof/exact_sides.hpp"
#include "test/proof/placement_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::PlacementTrial;
using oracle::Random;

Side side_of(const std::vector<Triangle>& faces, const Vector3d& point) {
  const bool is_on = std::any_of(faces.begin(), faces.end(), [&](const Triangle& face) {
    return oracle::is_exactly_on(face, point);
  });
  if (is_on) return Side::kOnSurface;
  return oracle::exact_winding(faces, point) != 0 ? Side::kInside : Side::kOutside;
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

/// The faces of a mesh, each with its own vertices.
std::vector<Triangle> faces_of(const TriangleMesh& mesh) {
  std::vector<Triangle> faces;
  for (const FaceIndices& face : mesh.faces()) faces.push_back(mesh.triangle(face));
  return faces;
}

class PlacementWith : public CollisionQueryWith {
 protected:
  const AxisPlacement& placement(const ShaftAxis& axis, const TriangleMesh& organ,
                                 const SurfaceTopology* topology) {
    query_.evaluate(placement_of(axis, organ, topology), result_);
    return result_.placement;
  }

  /// Expects crossings, but no sides.
  void expect_no_sides(const ShaftAxis& axis, const TriangleMesh& organ,
                       const SurfaceTopology* topology) {
    const AxisPlacement& found = placement(axis, organ, topology);
    EXPECT_EQ(found.tip, Side::kUnknown);
    EXPECT_EQ(found.trocar, Side::kUnknown);
    EXPECT_FALSE(found.length_known);
    EXPECT_EQ(found.length_inside, 0.0);
    const auto expected = oracle::exact_crossings(faces_of(organ), axis);
    ASSERT_EQ(found.crossings.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(found.crossings[i].face, expected[i].face);
      EXPECT_LE((found.crossings[i].barycentric - expected[i].barycentric).norm(), 1e-12);
    }
    crossings_ += expected.size();
  }

  std::size_t crossings_ = 0;
};

/// The tip of a tool of links alone.
TEST_P(PlacementWith, ATipWithoutAShaft) {
  Random random(85);
  const std::vector<Link> links = {{"jaw", {LinkPart::sphere(Vector3d::Zero(), 0.01)}}};
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    const std::size_t kind = static_cast<std::size_t>(i) % oracle::placement_trial_kinds().size();
    const PlacementTrial trial = oracle::make_placement_trial(kind, random);
    CollisionRequest request = placement_of(kNoShaft, trial.organ, &trial.topology);
    request.radius = 0.0;
    request.links = &links;
    request.path = resting_path({kNoShaft, {Eigen::Isometry3d::Identity()}});
    request.tip = trial.axis.tip;
    query_.evaluate(request, result_);
    EXPECT_EQ(result_.placement.tip, side_of(trial.faces, trial.axis.tip)) << trial;
    EXPECT_EQ(result_.placement.trocar, Side::kUnknown);
    EXPECT_TRUE(result_.placement.crossings.empty());
    EXPECT_FALSE(result_.placement.length_known);
    inside += result_.placement.tip == Side::kInside;
    request.surface_topology = nullptr;
    query_.evaluate(request, result_);
    EXPECT_EQ(result_.placement.tip, Side::kUnknown);
    request.surface_topology = &trial.topology;
    request.tip.reset();
    query_.evaluate(request, result_);
    EXPECT_EQ(result_.placement.tip, Side::kUnknown);
  }
  EXPECT_GT(inside, 30);
}

// Open surfaces, surfaces without a topology, and separate triangles whose corners drift apart by
// more than the tolerance.
TEST_P(PlacementWith, WhatIsNotKnownToBeClosedHasNoSides) {
  Random random(87);
  const GridSurface whole = shuffled(unwelded(torus(6, 11, 0.1, 0.4)), 9);
  const SurfaceTopology of_whole(whole.faces, whole.vertices);
  const TriangleMesh torn = mesh(shaken(whole, 2e-6, random));
  for (int i = 0; i < 100; ++i) {
    const PlacementTrial trial = oracle::make_placement_trial(0, random);
    expect_no_sides(trial.axis, trial.organ, nullptr);
    std::vector<std::uint32_t> triangles;
    for (const FaceIndices& face : trial.organ.faces()) {
      triangles.insert(triangles.end(), face.begin(), face.end());
    }
    const TriangleMesh open(trial.organ.vertices(), {triangles.begin() + 3, triangles.end()});
    const SurfaceTopology topology(open.faces(), open.vertices());
    if (!topology.is_closed()) expect_no_sides(trial.axis, open, &topology);
    expect_no_sides({random.point(0.2), random.point(0.2)}, torn, &of_whole);
  }
  EXPECT_GT(crossings_, 60U);
}

/// The end of the step counts: of the tool and of the organ. Nothing remains of the last answer.
TEST_P(PlacementWith, IsThatAtTheEndOfTheStep) {
  const GridSurface surface = sphere(6, 9, 0.1), earlier = moved(surface, {0.3F, 0.0F, 0.0F});
  const TriangleMesh before(earlier.vertices, earlier.triangles());
  const TriangleMesh after(surface.vertices, surface.triangles());
  const SurfaceTopology topology(surface.faces, surface.vertices);
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

  request.placement = false;
  query_.evaluate(request, result_);
  EXPECT_EQ(result_.placement.tip, Side::kUnknown);
  EXPECT_EQ(result_.placement.trocar, Side::kUnknown);
  EXPECT_TRUE(result_.placement.crossings.empty());
  EXPECT_FALSE(result_.placement.length_known);
  EXPECT_EQ(result_.placement.length_inside, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Pickers, PlacementWith, testing::ValuesIn(picker_kinds()));

}  // namespace
}  // namespace organ_collision
