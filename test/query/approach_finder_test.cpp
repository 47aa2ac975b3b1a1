#include "query/approach_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "approach_scenes.hpp"
#include "query/clearance_finder.hpp"
#include "query/near_finder.hpp"

namespace organ_collision {
namespace {

using oracle::Random;

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
