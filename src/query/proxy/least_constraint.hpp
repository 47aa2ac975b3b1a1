#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace organ_collision {

/// The coordinates of a small motion of a tool [m]. Their Euclidean norm measures how large the
/// motion is. Mobility says what each coordinate means.
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
/// If no motion stays in all half-spaces, the solution violates the worst one as little as
/// possible. For this, all walls share a slack, which is a seventh coordinate
/// (doc/theory/geometry.md, Haptic proxy). The slack costs so much that it is only a millionth of
/// the sum of the loads if some motion stays in all half-spaces.
class LeastConstraint {
 public:
  /// Makes at most kMostChanges rounds of O(walls) time. Each round adds a violated wall to the
  /// active walls, on which the solution lies. Only rounding errors can make more rounds necessary.
  /// The solution may then violate some walls.
  void solve(const Displacement& goal, const std::vector<Wall>& walls);

  /// The solution [m].
  const Displacement& displacement() const { return displacement_; }
  /// [m] The slack: the solution violates no wall by more than this.
  double violation() const { return violation_; }
  /// [m] The load of the wall with this index. Not negative. The sum of load * row over all walls
  /// is goal - displacement().
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
  Point loads_;                                           ///< the load of each active wall
  std::size_t walls_[kMostActive] = {};
  Displacement displacement_ = Displacement::Zero();
  double violation_ = 0.0;
};

}  // namespace organ_collision
