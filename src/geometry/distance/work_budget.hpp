#pragma once

#include <algorithm>
#include <cstdint>

namespace organ_collision {

/// Limits the work of one query's exact tests. Work is counted in steps, not timed, so that the
/// same query always gets the same answer. A step takes 0.1 to 0.15 us. The distance of a face from
/// an axis costs two steps. The distance from a cylinder costs three steps, and one more for six
/// slopes of Newton's method. Any other distance costs about one step for each iteration, and a
/// test against a box one step. The quick tests that exclude faces beforehand are not counted.
class WorkBudget {
 public:
  /// The budget is this many steps for each pair of a face and a convex part on each leg, whether
  /// they are near each other or not. A tool mesh has a convex part for each triangle.
  static constexpr std::uint64_t kStepsForEachPair = 2;
  /// A query with fewer pairs gets the budget for kLeastPairs.
  static constexpr std::uint64_t kLeastPairs = 100'000;
  /// A query with more pairs gets the budget for kMostPairs: two to three seconds.
  static constexpr std::uint64_t kMostPairs = 10'000'000;

  /// Like kStepsForEachPair, but for searches for the closest approach. It is larger because each
  /// of these searches computes several distances. The largest budget of a query is the same for
  /// both: kStepsForEachPair * kMostPairs.
  static constexpr std::uint64_t kApproachStepsForEachPair = 20;

  explicit WorkBudget(std::uint64_t steps_for_each_pair = kStepsForEachPair)
      : steps_for_each_pair_(steps_for_each_pair) {}
  /// The budget for searches for the closest approach.
  static WorkBudget for_approaches() { return WorkBudget(kApproachStepsForEachPair); }
  /// A budget that is never used up.
  static WorkBudget unlimited() {
    WorkBudget budget;
    budget.is_limited_ = false;
    return budget;
  }

  void add_pairs(std::uint64_t count) { pairs_ += count; }
  void spend(std::uint64_t steps) { spent_ += steps; }
  /// The number of steps that were spent so far.
  std::uint64_t spent() const { return spent_; }
  bool is_used_up() const {
    constexpr std::uint64_t kMostSteps = kStepsForEachPair * kMostPairs;
    return is_limited_ &&
           spent_ >= std::min(kMostSteps,
                              steps_for_each_pair_ * std::clamp(pairs_, kLeastPairs, kMostPairs));
  }

  /// Notes that a search ended early because the budget was used up.
  void add_cut() { ++cuts_; }
  std::uint64_t cuts() const { return cuts_; }

 private:
  std::uint64_t steps_for_each_pair_;
  std::uint64_t pairs_ = 0, spent_ = 0, cuts_ = 0;
  bool is_limited_ = true;
};

}  // namespace organ_collision
