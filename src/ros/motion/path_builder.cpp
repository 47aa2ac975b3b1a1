#include "path_builder.hpp"

#include <algorithm>
#include <utility>

namespace organ_collision {
namespace {

/// [m] A bend of an axis, or a way of a trocar, by less is none.
constexpr double kStraight = 1e-9;
/// [m] The same for points of links.
constexpr double kStraightLink = 1e-6;

/// A trocar that moves by rounding alone is at rest, for which viewing volumes are tighter.
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
  const double added = size > 1 ? bend(path_[size - 2], path_[size - 1], next) : 0.0;
  // Each waypoint left out turns the leg by no more than its own bend: the sum bounds them all.
  if (size > 1 && bends_left_out_ + added <= 1.0) {
    bends_left_out_ += added;
    path_.back() = std::move(next);
  } else {
    bends_left_out_ = 0.0;
    path_.push_back(std::move(next));
  }
}

ToolPath PathBuilder::take() {
  rest_trocar(path_);
  return std::move(path_);
}

/// How far `b` is from the straight way from `a` to `c`, at its time, as a share of what counts as
/// straight.
double PathBuilder::bend(const ToolWaypoint& a, const ToolWaypoint& b,
                         const ToolWaypoint& c) const {
  const Deviation deviation = deviation_(b, StraightWay(a, c));
  return std::max(deviation.axis / kStraight, deviation.links / kStraightLink);
}

}  // namespace organ_collision
