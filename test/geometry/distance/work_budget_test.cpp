#include "geometry/distance/work_budget.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

TEST(WorkBudget, IsUsedUpByItsLastStep) {
  WorkBudget budget;
  budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kLeastPairs - 1);
  EXPECT_FALSE(budget.is_used_up());
  budget.spend(1);
  EXPECT_TRUE(budget.is_used_up());
}

TEST(WorkBudget, GrowsWithThePairsBeyondTheLeast) {
  WorkBudget budget;
  budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kLeastPairs);
  budget.add_pairs(WorkBudget::kLeastPairs);
  EXPECT_TRUE(budget.is_used_up());
  budget.add_pairs(1);
  EXPECT_FALSE(budget.is_used_up());
  budget.spend(WorkBudget::kStepsForEachPair);
  EXPECT_TRUE(budget.is_used_up());
}

TEST(WorkBudget, GrowsNoFurtherThanTheMostPairs) {
  WorkBudget budget;
  budget.add_pairs(1000 * WorkBudget::kMostPairs);
  budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kMostPairs - 1);
  EXPECT_FALSE(budget.is_used_up());
  budget.spend(1);
  EXPECT_TRUE(budget.is_used_up());
}

TEST(WorkBudget, UnlimitedIsNeverUsedUp) {
  WorkBudget budget = WorkBudget::unlimited();
  budget.spend(std::uint64_t{1} << 60U);
  EXPECT_FALSE(budget.is_used_up());
}

TEST(WorkBudget, ApproachesGetMoreForEachPairButNotMoreInAll) {
  WorkBudget budget = WorkBudget::for_approaches();
  budget.spend(WorkBudget::kApproachStepsForEachPair * WorkBudget::kLeastPairs - 1);
  EXPECT_FALSE(budget.is_used_up());
  budget.spend(1);
  EXPECT_TRUE(budget.is_used_up());

  WorkBudget large = WorkBudget::for_approaches();
  large.add_pairs(1000 * WorkBudget::kMostPairs);
  large.spend(WorkBudget::kStepsForEachPair * WorkBudget::kMostPairs);
  EXPECT_TRUE(large.is_used_up());
}

TEST(WorkBudget, CutsAreNotForgottenIfMorePairsCome) {
  WorkBudget budget;
  budget.spend(WorkBudget::kStepsForEachPair * WorkBudget::kLeastPairs);
  EXPECT_EQ(budget.cuts(), 0U);
  budget.add_cut();
  budget.add_pairs(2 * WorkBudget::kLeastPairs);
  EXPECT_FALSE(budget.is_used_up());
  EXPECT_EQ(budget.cuts(), 1U);
}

}  // namespace
}  // namespace organ_collision
