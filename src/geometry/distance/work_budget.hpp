#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

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

  /// The budget of a search for the clearance: a quarter of a second.
  static constexpr std::uint64_t kClearanceSteps = 2'000'000;
  /// The budget of a search for near faces: this many steps, and more for each face that is asked
  /// for and for each leg of each part of the tool. It does not grow with the organ, so that the
  /// search takes a few milliseconds at most even if all faces are equally far.
  static constexpr std::uint64_t kNearSteps = 50'000;
  static constexpr std::uint64_t kStepsForEachNearFace = 500;
  static constexpr std::uint64_t kStepsForEachLeg = 200;

  /// The budget for contacts, which grows with the pairs.
  WorkBudget()
      : least_steps_(kStepsForEachPair * kLeastPairs),
        most_steps_(kStepsForEachPair * kMostPairs) {}
  static WorkBudget for_clearance() { return WorkBudget(kClearanceSteps); }
  /// `legs`: the number of legs, those of each part of the tool counted by themselves.
  static WorkBudget for_near(std::uint64_t faces, std::uint64_t legs) {
    return WorkBudget(kNearSteps + kStepsForEachNearFace * faces + kStepsForEachLeg * legs);
  }
  /// A budget that is never used up.
  static WorkBudget unlimited() { return WorkBudget(std::numeric_limits<std::uint64_t>::max()); }

  void add_pairs(std::uint64_t count) { pairs_ += count; }
  void spend(std::uint64_t steps) { spent_ += steps; }
  /// The number of steps that were spent so far.
  std::uint64_t spent() const { return spent_; }
  bool is_used_up() const {
    return spent_ >= std::clamp(kStepsForEachPair * pairs_, least_steps_, most_steps_);
  }

  /// Notes that a search ended early because the budget was used up.
  void add_cut() { ++cuts_; }
  std::uint64_t cuts() const { return cuts_; }

 private:
  explicit WorkBudget(std::uint64_t steps) : least_steps_(steps), most_steps_(steps) {}

  std::uint64_t least_steps_, most_steps_;
  std::uint64_t pairs_ = 0, spent_ = 0, cuts_ = 0;
};

}  // namespace organ_collision
