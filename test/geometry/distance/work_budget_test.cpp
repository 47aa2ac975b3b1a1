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

}  // namespace
}  // namespace organ_collision
