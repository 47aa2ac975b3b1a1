#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "query/clearance_finder.hpp"
#include "scenes.hpp"
#include "test/grid_surface.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

CollisionResult answer(const CollisionRequest& request) {
  static CollisionQuery query;
  CollisionResult result;
  query.evaluate(request, result);
  EXPECT_EQ(result.unresolved, 0U);
  return result;
}

void move_by(const Vector3d& offset, ToolWaypoint& waypoint) {
  waypoint.axis.trocar += offset;
  waypoint.axis.tip += offset;
  for (Eigen::Isometry3d& pose : waypoint.links) pose.translation() += offset;
}

/// The parts of a clearance fit together, and to the request.
void expect_consistent(const ToolClearance& clearance, const CollisionRequest& request) {
  EXPECT_TRUE(clearance.is_resolved);
  ASSERT_EQ(clearance.state, ClearanceState::kKnown);
  EXPECT_NEAR(clearance.normal.norm(), 1.0, 1e-12);
  EXPECT_LE((clearance.on_organ - clearance.on_tool - clearance.distance * clearance.normal).norm(),
            1e-15);
  EXPECT_EQ(clearance.vertices, request.organ->faces()[clearance.face]);
  EXPECT_NEAR(clearance.barycentric.sum(), 1.0, 1e-12);
  EXPECT_GE(clearance.barycentric.minCoeff(), 0.0);
  EXPECT_LE((point_at(request.organ->triangle(clearance.face), clearance.barycentric) -
             clearance.on_organ)
                .norm(),
            1e-12);
  EXPECT_LE(clearance.least, std::max(clearance.distance, 0.0));
  EXPECT_GE(clearance.least_fraction, 0.0);
  EXPECT_LE(clearance.least_fraction, 1.0);
}

TEST(ClearanceFinder, AtRestIsTheLeastDistanceOfAllFaces) {
  Random random(1);
  for (int i = 0; i < 400; ++i) {
    LinkScene scene(true, random);
    scene.request.mode = QueryMode::kStatic;
    scene.request.clearance = true;
    const CollisionResult result = answer(scene.request);
    const ToolClearance& clearance = result.clearance;
    expect_consistent(clearance, scene.request);
    EXPECT_TRUE(clearance.unlimited);
    EXPECT_EQ(clearance.margin, 0.0);
    const auto nearest = MeasuredApproaches(scene.request, true).nearest();
    EXPECT_NEAR(clearance.distance, nearest.distance, kExact);
    EXPECT_EQ(clearance.least, clearance.distance);
    EXPECT_EQ(clearance.least_fraction, 0.0);
  }
}

TEST(ClearanceFinder, OfAStepIsTheLeastDistanceAtAnyTime) {
  Random random(2);
  int apart = 0;
  for (int i = 0; i < 300; ++i) {
    LinkScene scene(true, random);
    scene.request.clearance = true;
    if (random.chance(0.3)) scene.request.path.resize(1);
    if (random.chance(0.6)) {  // Away from the organ, so that nothing is touched.
      const Vector3d away = 0.4 * random.direction();
      for (ToolWaypoint& waypoint : scene.request.path) move_by(away, waypoint);
    }
    const CollisionResult result = answer(scene.request);
    expect_consistent(result.clearance, scene.request);
    EXPECT_NEAR(result.clearance.distance,
                MeasuredApproaches(scene.request, true).nearest().distance, kExact);
    if (!result.contacts.empty()) {
      double first = 1.0;
      for (const FaceContact& contact : result.contacts) first = std::min(first, contact.fraction);
      EXPECT_EQ(result.clearance.least, 0.0);
      EXPECT_EQ(result.clearance.least_fraction, first);
      continue;
    }
    ++apart;
    EXPECT_NEAR(result.clearance.least, MeasuredApproaches(scene.request, false).nearest().distance,
                kMoving);
  }
  EXPECT_GT(apart, 100);
}

TEST(ClearanceFinder, IsKnownUpToTheMargin) {
  Random random(3);
  int beyond = 0;
  for (int i = 0; i < 300; ++i) {
    LinkScene scene(true, random);
    const Vector3d away = random.uniform(0.0, 0.4) * random.direction();
    for (ToolWaypoint& waypoint : scene.request.path) move_by(away, waypoint);
    if (random.chance(0.5)) scene.request.mode = QueryMode::kStatic;
    const double distance = MeasuredApproaches(scene.request, true).nearest().distance;
    scene.request.margin =
        distance > 0.0 ? distance * random.uniform(0.2, 3.0) : random.scale(1e-4, 1.0);
    const ToolClearance clearance = answer(scene.request).clearance;
    EXPECT_EQ(clearance.margin, scene.request.margin);
    EXPECT_FALSE(clearance.unlimited);
    if (distance <= scene.request.margin) {
      expect_consistent(clearance, scene.request);
      EXPECT_NEAR(clearance.distance, distance, kExact);
    } else {
      ++beyond;
      EXPECT_EQ(clearance.state, ClearanceState::kBeyondMargin);
      EXPECT_EQ(clearance.distance, 0.0);
      EXPECT_EQ(clearance.least, 0.0);
    }
  }
  EXPECT_GT(beyond, 30);
}

TEST(ClearanceFinder, OfAShaftIsPositiveExactlyIfNothingIsTouched) {
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    const Soup soup = scattered_faces(60, random);
    const TriangleMesh organ = mesh(soup);
    CollisionRequest request = swept(organ, random_path(true, random), random.scale(1e-3, 0.02));
    request.mode = QueryMode::kStatic;
    request.clearance = true;
    const CollisionResult result = answer(request);
    EXPECT_EQ(result.clearance.distance <= 0.0, !result.contacts.empty());
    EXPECT_GE(result.clearance.distance, -request.radius - 1e-12);
  }
}

TEST(ClearanceFinder, NormalIsTheFacesOwnIfTheAxisPiercesIt) {
  const TriangleMesh organ({-0.05F, -0.05F, 0.1F, 0.05F, -0.05F, 0.1F, 0.0F, 0.05F, 0.1F},
                           {0, 1, 2});
  CollisionRequest request =
      swept(organ, {{0.0, {{0.003, 0.002, 0.3}, {0.001, -0.004, 0.02}}}}, 0.005);
  request.mode = QueryMode::kStatic;
  request.clearance = true;
  const ToolClearance clearance = answer(request).clearance;
  EXPECT_FALSE(clearance.normal_defined);
  EXPECT_LE((clearance.normal - Vector3d(0.0, 0.0, -1.0)).norm(), 1e-6);
  EXPECT_NEAR(clearance.distance, -request.radius, 1e-12);

  request.path[0].axis.tip.z() = 0.11;
  const ToolClearance above = answer(request).clearance;
  EXPECT_TRUE(above.normal_defined);
  EXPECT_NEAR(above.distance, 0.01 - request.radius, 1e-8);
  EXPECT_LE((above.on_organ - Vector3d(0.001, -0.004, 0.1)).norm(), 1e-8);
  EXPECT_LE((above.on_tool - Vector3d(0.001, -0.004, 0.105)).norm(), 1e-8);
}

TEST(ClearanceFinder, IsFarBeyondTheOrgansSize) {
  Random random(5);
  const TriangleMesh organ = mesh(liver());
  for (const double away : {1.0, 30.0, 1e3, 1e5}) {
    const Vector3d offset = away * random.direction();
    const ShaftAxis axis{offset + random.point(0.1), offset + random.point(0.1)};
    CollisionRequest request = swept(organ, {{0.0, axis}}, 0.004);
    request.mode = QueryMode::kStatic;
    request.margin = 2.0 * away;
    const ToolClearance clearance = answer(request).clearance;
    expect_consistent(clearance, request);
    EXPECT_NEAR(clearance.distance, MeasuredApproaches(request, true).nearest().distance,
                kExact + 1e-14 * away);
  }
}

TEST(ClearanceFinder, DoesNotDependOnTheOrderOfFacesAndVertices) {
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    const GridSurface grid = grid_surface(20, random.uniform(0.0, 6.0));
    const GridSurface other = shuffled(grid, static_cast<unsigned>(i));
    const TriangleMesh organ(grid.vertices, grid.triangles());
    const TriangleMesh reordered(other.vertices, other.triangles());
    CollisionRequest request = swept(organ, random_path(true, random), 0.003);
    request.clearance = true;
    const ToolClearance expected = answer(request).clearance;
    request.organ = &reordered;
    const ToolClearance clearance = answer(request).clearance;
    EXPECT_NEAR(clearance.distance, expected.distance, 1e-12);
    EXPECT_NEAR(clearance.least, expected.least, kMoving);
  }
}

TEST(ClearanceFinder, IsNotAskedForByDefault) {
  Random random(7);
  const LinkScene scene(true, random);
  EXPECT_EQ(answer(scene.request).clearance.state, ClearanceState::kNotAsked);
}

CollisionResult answer(const CollisionRequest& request) {
  static CollisionQuery query;
  CollisionResult result;
  query.evaluate(request, result);
  EXPECT_EQ(result.near_unresolved, 0U);
  return result;
}

bool is_touched(const CollisionResult& result, std::uint32_t face) {
  return std::any_of(result.contacts.begin(), result.contacts.end(),
                     [face](const FaceContact& contact) { return contact.face == face; });
}

/// The distances of the faces that are not touched, in rising order.
std::vector<double> untouched(const MeasuredApproaches& measured, const CollisionResult& result) {
  std::vector<double> distances;
  for (std::uint32_t face = 0; face < measured.least().size(); ++face) {
    if (!is_touched(result, face)) distances.push_back(measured.least()[face].distance);
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

void expect_near_faces(const CollisionRequest& request, double slack) {
  const CollisionResult result = answer(request);
  const MeasuredApproaches measured(request, request.mode == QueryMode::kStatic);
  const std::vector<double> expected = untouched(measured, result);
  const auto within = [&](double margin) {
    return static_cast<std::size_t>(std::upper_bound(expected.begin(), expected.end(), margin) -
                                    expected.begin());
  };
  const std::size_t count = result.near.size() + result.near_left_out;
  EXPECT_GE(count, within(request.margin - slack));
  EXPECT_LE(count, within(request.margin + slack));
  EXPECT_LE(result.near.size(), request.max_near);
  EXPECT_EQ(result.near.size() < request.max_near,
            result.near_left_out == 0 && count < request.max_near);
  for (std::size_t i = 0; i < result.near.size(); ++i) {
    const FaceContact& near = result.near[i];
    EXPECT_FALSE(is_touched(result, near.face));
    EXPECT_NEAR(-near.depth, expected[i], slack);
    EXPECT_NEAR(-near.depth, measured.least()[near.face].distance, slack);
    if (i > 0) {
      EXPECT_LE(-result.near[i - 1].depth, -near.depth);
    }
    EXPECT_EQ(near.vertices, request.organ->faces()[near.face]);
    EXPECT_NEAR(near.normal.norm(), 1.0, 1e-12);
    EXPECT_NEAR(near.barycentric.sum(), 1.0, 1e-12);
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(result.near[j].face, near.face);
  }
}

TEST(NearFinder, FindsTheNearestFacesAtRest) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    LinkScene scene(true, random);
    scene.request.mode = QueryMode::kStatic;
    scene.request.margin = random.scale(1e-3, 0.3);
    scene.request.max_near = static_cast<std::size_t>(random.integer(1, 200));
    expect_near_faces(scene.request, kExact);
  }
}

TEST(NearFinder, FindsTheNearestFacesOfAStep) {
  Random random(2);
  for (int i = 0; i < 150; ++i) {
    LinkScene scene(true, random);
    scene.request.margin = random.scale(1e-3, 0.1);
    scene.request.max_near = static_cast<std::size_t>(random.integer(1, 200));
    expect_near_faces(scene.request, kMoving);
  }
}

TEST(NearFinder, PointIsAtTheDistanceAlongTheNormal) {
  Random random(3);
  std::size_t checked = 0;
  for (int i = 0; i < 100; ++i) {
    const TriangleMesh organ = mesh(scattered_faces(100, random));
    CollisionRequest request = swept(organ, random_path(true, random), random.scale(1e-3, 0.02));
    request.margin = 0.05;
    request.max_near = 1000;
    for (const FaceContact& near : answer(request).near) {
      // The axis at the time of the closest approach.
      const auto next = std::find_if(request.path.begin() + 1, request.path.end() - 1,
                                     [&](const auto& w) { return w.fraction >= near.fraction; });
      const auto& from = *(next - 1);
      const double time = (near.fraction - from.fraction) / (next->fraction - from.fraction);
      const ShaftAxis axis = ShaftMotion{from.axis, next->axis}.at(time);
      EXPECT_LE(
          (near.point - axis.at(near.shaft) - (request.radius - near.depth) * near.normal).norm(),
          1e-12);
      ++checked;
    }
  }
  EXPECT_GT(checked, 500U);
}

TEST(NearFinder, TwoCallsDoNotAffectEachOther) {
  Random random(4);
  LinkScene large(true, random);
  const TriangleMesh small_organ = mesh(scattered_faces(5, random));
  LinkScene small(true, random);
  small.request.organ = &small_organ;
  small.request.organ_before = nullptr;
  for (CollisionRequest* request : {&large.request, &small.request, &large.request}) {
    request->margin = 0.1;
    request->max_near = 50;
    expect_near_faces(*request, kMoving);
  }
}

/// Keeps all that it gets.
class Recorder : public ApproachSink {
 public:
  explicit Recorder(double bound) : bound_(bound) {}
  double bound() const override { return bound_; }
  void add(const PartApproach& approach) override {
    const auto known = least.emplace(approach.face, approach.distance).first;
    known->second = std::min(known->second, approach.distance);
  }
  void add_unresolved(std::uint32_t face) override { unresolved.insert(face); }

  std::map<std::uint32_t, double> least;  ///< [m] by face
  std::set<std::uint32_t> unresolved;

 private:
  double bound_;
};

/// A budget of which only this many steps are left.
WorkBudget with_steps_left(std::uint64_t steps) {
  WorkBudget budget = WorkBudget::for_approaches();
  budget.spend(WorkBudget::kApproachStepsForEachPair * WorkBudget::kLeastPairs - steps);
  return budget;
}

/// From one leg that is settled at once to many legs with long searches.
std::vector<std::uint64_t> budgets() { return {0, 1, 7, 30, 200, 1000, 5000, 30'000, 2'000'000}; }

TEST(ApproachFinder, FindsEveryFaceWithinTheBoundOrSaysThatItIsUnresolved) {
  Random random(1);
  std::size_t unresolved = 0;
  for (int i = 0; i < 40; ++i) {
    const LinkScene scene(true, random);
    const MeasuredApproaches measured(scene.request, false);
    BlockBoxes boxes;
    const Step step(scene.request, scene.request.path, boxes);
    for (const std::uint64_t steps : budgets()) {
      Recorder found(0.08);
      WorkBudget budget = with_steps_left(steps);
      ApproachFinder().find(step, budget, found);
      unresolved += found.unresolved.size();
      for (std::uint32_t face = 0; face < scene.organ.face_count(); ++face) {
        const double distance = measured.least()[face].distance;
        if (distance > 0.08 - kMoving || found.unresolved.count(face) != 0) continue;
        ASSERT_EQ(found.least.count(face), 1U) << "face " << face << ", steps " << steps;
        EXPECT_NEAR(found.least[face], distance, kMoving) << "face " << face << ", steps " << steps;
      }
      if (steps == budgets().back()) {
        EXPECT_TRUE(found.unresolved.empty());
      }
    }
  }
  EXPECT_GT(unresolved, 10'000U);
}

TEST(ApproachFinder, NearFacesAreRightOrUnresolved) {
  Random random(2);
  for (int i = 0; i < 40; ++i) {
    LinkScene scene(true, random);
    scene.request.margin = 0.08;
    scene.request.max_near = 1000;
    const MeasuredApproaches measured(scene.request, false);
    BlockBoxes boxes;
    const Step step(scene.request, scene.request.path, boxes);
    CollisionResult all;
    NearFinder finder;
    finder.find(step, scene.request, all);
    EXPECT_EQ(all.near_unresolved, 0U);
    for (const std::uint64_t steps : budgets()) {
      CollisionResult result;
      finder.find(step, scene.request, result, with_steps_left(steps));
      for (const FaceContact& near : result.near) {
        EXPECT_NEAR(-near.depth, measured.least()[near.face].distance, kMoving);
      }
      EXPECT_GE(result.near.size() + result.near_unresolved, all.near.size());
    }
  }
}

TEST(ApproachFinder, TheClearanceIsRightOrUnresolved) {
  Random random(3);
  std::size_t unresolved = 0;
  for (int i = 0; i < 100; ++i) {
    LinkScene scene(true, random);
    scene.request.clearance = true;
    const double distance = MeasuredApproaches(scene.request, true).nearest().distance;
    const double least = MeasuredApproaches(scene.request, false).nearest().distance;
    BlockBoxes boxes;
    const Step step(scene.request, scene.request.path, boxes);
    for (const std::uint64_t steps : budgets()) {
      const ToolClearance clearance =
          ClearanceFinder().find(step, scene.request, {}, with_steps_left(steps));
      if (clearance.is_resolved) {
        EXPECT_NEAR(clearance.distance, distance, 1e-9) << "steps " << steps;
        EXPECT_NEAR(clearance.least, least, kMoving) << "steps " << steps;
      } else {
        ++unresolved;
      }
    }
  }
  EXPECT_GT(unresolved, 100U);
}

}  // namespace

}  // namespace organ_collision
