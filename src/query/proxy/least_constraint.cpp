#include "least_constraint.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace organ_collision {
namespace {

/// [1] The seventh coordinate is the slack times this factor. The slack of the solution is then the
/// sum of the loads divided by the square of this factor.
constexpr double kSlackScale = 1e3;
/// [m] Violations of a wall that are smaller than this count as rounding errors.
constexpr double kSmallestViolation = 1e-12;
/// [1] A row counts as linearly dependent on the active rows if the square of its part at right
/// angles to them is at most this share of the row's own square.
constexpr double kDependent = 1e-12;

}  // namespace

void LeastConstraint::solve(const Displacement& goal, const std::vector<Wall>& walls) {
  point_ << goal, 0.0;
  count_ = 0;
  for (int change = 0; change < kMostChanges; ++change) {
    std::size_t worst = walls.size();
    double most = kSmallestViolation;
    const double slack = point_[6] / kSlackScale;
    for (std::size_t i = 0; i < walls.size(); ++i) {
      const double violation = walls[i].row.dot(point_.head<6>()) - slack - walls[i].bound;
      if (violation > most) {
        most = violation;
        worst = i;
      }
    }
    if (worst == walls.size()) break;
    Point row;
    row << walls[worst].row, -1.0 / kSlackScale;
    add(row, walls[worst].bound, worst);
  }
  displacement_ = point_.head<6>();
  violation_ = point_[6] / kSlackScale;
}

/// Moves the solution onto the wall, and keeps it on the active walls. Active walls whose loads
/// would become negative are dropped on the way.
void LeastConstraint::add(const Point& row, double bound, std::size_t wall) {
  double load = 0.0;
  while (true) {
    const double violation = row.dot(point_) - bound;
    const auto active = rows_.leftCols(count_);
    Point change = Point::Zero();  // how the active loads fall for each unit of the new load
    Point across = row;            // the part of `row` at right angles to the active rows
    if (count_ > 0) {
      using Gram =
          Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostActive, kMostActive>;
      const Gram gram = active.transpose() * active;
      const Eigen::LDLT<Gram> inverse(gram);
      change.head(count_) = inverse.solve(active.transpose() * row);
      across -= active * change.head(count_);
    }
    const double slope = across.dot(row);
    const bool is_dependent = count_ == kMostActive || !(slope > kDependent * row.squaredNorm());
    double step = is_dependent ? std::numeric_limits<double>::infinity() : violation / slope;
    int dropped = -1;
    for (int i = 0; i < count_; ++i) {
      if (change[i] > 0.0 && loads_[i] / change[i] < step) {
        step = loads_[i] / change[i];
        dropped = i;
      }
    }
    if (!std::isfinite(step)) return;  // Only rounding leads here: the slack can satisfy all walls.
    if (!is_dependent) point_ -= step * across;
    loads_.head(count_) -= step * change.head(count_);
    load += step;
    if (dropped < 0) {
      rows_.col(count_) = row;
      loads_[count_] = load;
      walls_[count_++] = wall;
      return;
    }
    drop(dropped);
  }
}

void LeastConstraint::drop(int active) {
  --count_;
  for (int i = active; i < count_; ++i) {
    rows_.col(i) = rows_.col(i + 1).eval();
    loads_[i] = loads_[i + 1];
    walls_[i] = walls_[i + 1];
  }
}

double LeastConstraint::load(std::size_t wall) const {
  for (int i = 0; i < count_; ++i) {
    if (walls_[i] == wall) return loads_[i];
  }
  return 0.0;
}

}  // namespace organ_collision
