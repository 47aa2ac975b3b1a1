#include "path_builder.hpp"

#include <algorithm>
#include <utility>

namespace organ_collision {
namespace {

/// [m] Smaller deviations of an axis and smaller motions of a trocar count as rounding errors.
constexpr double kStraight = 1e-9;
/// [m] The same for points of links.
constexpr double kStraightLink = 1e-6;

/// Stops a trocar that moves only by rounding errors: the viewing volumes of a resting trocar are
/// tighter.
void rest_trocar(ToolPath& path) {
  const Eigen::Vector3d trocar = path.back().axis.trocar;
  const auto is_there = [&](const ToolWaypoint& waypoint) {
    return (waypoint.axis.trocar - trocar).norm() <= kStraight;
  };
  if (!std::all_of(path.begin(), path.end(), is_there)) return;
  for (ToolWaypoint& waypoint : path) waypoint.axis.trocar = trocar;
}

}  // namespace

void PathBuilder::add(double fraction, const ToolPose& pose) {
  ToolWaypoint next{fraction, pose.axis, pose.links};
  const std::size_t size = path_.size();
  const double added = size > 1 ? relative_deviation(path_[size - 2], path_[size - 1], next) : 0.0;
  // Each dropped sample changes the leg by at most its own deviation, so the sum bounds the change.
  if (size > 1 && dropped_deviation_ + added <= 1.0) {
    dropped_deviation_ += added;
    path_.back() = std::move(next);
  } else {
    dropped_deviation_ = 0.0;
    path_.push_back(std::move(next));
  }
}

ToolPath PathBuilder::take() {
  rest_trocar(path_);
  return std::move(path_);
}

/// The deviation of `b` from the straight motion from `a` to `c` at the time of `b`, as a multiple
/// of the tolerance.
double PathBuilder::relative_deviation(const ToolWaypoint& a, const ToolWaypoint& b,
                                       const ToolWaypoint& c) const {
  const Deviation deviation = deviation_(b, StraightMotion(a, c));
  return std::max(deviation.axis / kStraight, deviation.links / kStraightLink);
}

}  // namespace organ_collision
