#pragma once

#include <algorithm>
#include <cstdint>

namespace organ_collision {

/// How much work the exact tests of one query may cost. Work is counted, never timed: the same
/// query always gets the same answer. A step is about a tenth of a microsecond: the distance of an
/// axis and a face takes two, other distances one for each iteration, a test against a box one.
class WorkBudget {
 public:
  /// The budget grows with the pairs of a face and a convex part that the query asks about, near
  /// each other or not.
  static constexpr std::uint64_t kStepsForEachPair = 2;
  /// Smaller queries may cost as much as one of so many pairs.
  static constexpr std::uint64_t kLeastPairs = 100'000;
  /// Larger ones no more than one of so many: about two seconds.
  static constexpr std::uint64_t kMostPairs = 10'000'000;

  /// As much work as it takes.
  static WorkBudget unlimited() {
    WorkBudget budget;
    budget.is_limited_ = false;
    return budget;
  }

  void add_pairs(std::uint64_t count) { pairs_ += count; }
  void spend(std::uint64_t steps) { spent_ += steps; }
  bool is_used_up() const {
    return is_limited_ && spent_ >= kStepsForEachPair * std::clamp(pairs_, kLeastPairs, kMostPairs);
  }
  std::uint64_t spent() const { return spent_; }

 private:
  std::uint64_t pairs_ = 0, spent_ = 0;
  bool is_limited_ = true;
};

}  // namespace organ_collision
