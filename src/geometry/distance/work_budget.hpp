#pragma once

#include <algorithm>
#include <cstdint>

namespace organ_collision {

/// Limits the work of one query's exact tests. Work is counted in steps, not timed, so that the
/// same query always gets the same answer. A step takes 0.1 to 0.15 us. The distance between an
/// axis and a face costs two steps, that of a cylinder three and one more for six slopes of
/// Newton's method, any other distance about one for each iteration, and a test against a box one.
/// The quick tests that sort out faces before these are not counted.
class WorkBudget {
 public:
  /// The budget is this many steps for each pair of a face and a convex part in the query, whether
  /// they are near each other or not.
  static constexpr std::uint64_t kStepsForEachPair = 2;
  /// Queries with fewer pairs get the budget of this many.
  static constexpr std::uint64_t kLeastPairs = 100'000;
  /// Queries with more pairs get the budget of this many: two to three seconds.
  static constexpr std::uint64_t kMostPairs = 10'000'000;

  /// Closest approaches get this many steps for each pair, because each takes several distances.
  /// The most that a query gets is the same.
  static constexpr std::uint64_t kApproachStepsForEachPair = 20;

  explicit WorkBudget(std::uint64_t steps_for_each_pair = kStepsForEachPair)
      : steps_for_each_pair_(steps_for_each_pair) {}
  /// The budget of a query's closest approaches.
  static WorkBudget for_approaches() { return WorkBudget(kApproachStepsForEachPair); }
  /// A budget that is never used up.
  static WorkBudget unlimited() {
    WorkBudget budget;
    budget.is_limited_ = false;
    return budget;
  }

  void add_pairs(std::uint64_t count) { pairs_ += count; }
  void spend(std::uint64_t steps) { spent_ += steps; }
  /// The number of steps so far.
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
