#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace organ_collision {

/// Coordinates of a small motion of a tool [m], in a space whose metric is the identity. Mobility
/// says what they mean.
using Displacement = Eigen::Matrix<double, 6, 1>;

/// A half-space that a motion must stay in: row · displacement <= bound.
struct Wall {
  Displacement row = Displacement::Zero();  ///< [1]
  double bound = 0.0;                       ///< [m]
};

/// Finds the motion nearest a goal that stays in all half-spaces (Gauss' principle of least
/// constraint): a small convex quadratic problem, solved by the dual method of Goldfarb and Idnani
/// (1983), which begins at the goal and adds the walls that are violated one by one.
///
/// If no motion stays in all of them, the solution violates them by the least possible distance.
/// For this, a slack that all walls share is a seventh coordinate. It costs so much that it is a
/// millionth of the sum of the loads if it need not be used.
class LeastConstraint {
 public:
  /// Takes O(walls) time for each of at most kMostChanges changes of the active walls. If that is
  /// not enough, which only rounding can cause, the solution may violate some walls.
  void solve(const Displacement& goal, const std::vector<Wall>& walls);

  /// The solution [m].
  const Displacement& displacement() const { return displacement_; }
  /// [m] By how much the solution violates the walls.
  double violation() const { return violation_; }
  /// [m] The load of a wall: goal - displacement() = sum of load * row. Not negative.
  double load(std::size_t wall) const;
  /// Whether a wall keeps the solution from the goal.
  bool is_held() const { return count_ > 0; }

 private:
  static constexpr int kMostActive = 7;
  static constexpr int kMostChanges = 100;
  using Point = Eigen::Matrix<double, kMostActive, 1>;

  void add(const Point& row, double bound, std::size_t wall);
  void drop(int active);

  Point point_;  ///< the displacement and the scaled slack
  int count_ = 0;
  Eigen::Matrix<double, kMostActive, kMostActive> rows_;  ///< a column for each active wall
  Point loads_;                                           ///< of the active walls
  std::size_t walls_[kMostActive] = {};
  Displacement displacement_ = Displacement::Zero();
  double violation_ = 0.0;
};

}  // namespace organ_collision
