#include "organ_collision/ros/path_builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "organ_collision/geometry/rigid_motion.hpp"

namespace organ_collision {
namespace {

/// [m] A bend of an axis, or a way of a trocar, by less is none.
constexpr double kStraight = 1e-9;
/// [m] The same for points of links.
constexpr double kStraightLink = 1e-6;

/// [m] The farthest that any point of the link lies from its origin, or farther.
double reach(const Link& link) {
  double farthest = 0.0;
  for (const LinkPart& part : link.parts) {
    const OrientedBox& box = part.bounds;
    const Eigen::Vector3d center = box.axes.transpose() * box.center;
    farthest = std::max(farthest, (center.cwiseAbs() + box.half_size).norm() + part.radius);
  }
  return farthest;
}

/// [m] How far two axes are apart, end by end.
double distance(const ShaftAxis& a, const ShaftAxis& b) {
  return std::max((a.trocar - b.trocar).norm(), (a.tip - b.tip).norm());
}

/// [m] How far any point within `reach` of the origin is from where it would be in another pose, or
/// farther. Turning by an angle moves it by 2 reach sin(angle / 2), and the turns' matrices differ
/// by sqrt(8) sin(angle / 2).
double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double reach) {
  return (a.translation() - b.translation()).norm() +
         reach * std::sqrt(0.5) * (a.linear() - b.linear()).norm();
}

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

PathBuilder::PathBuilder(const std::vector<Link>& links, const ToolPose& begin)
    : path_(resting_path(begin)) {
  for (const Link& link : links) reaches_.push_back(reach(link));
}

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
  const double time = (b.fraction - a.fraction) / (c.fraction - a.fraction);
  double bend = distance(ShaftMotion{a.axis, c.axis}.at(time), b.axis) / kStraight;
  for (std::size_t i = 0; i < reaches_.size(); ++i) {
    const Eigen::Isometry3d straight = RigidMotion(a.links[i], c.links[i]).at(time);
    bend = std::max(bend, distance(straight, b.links[i], reaches_[i]) / kStraightLink);
  }
  return bend;
}

}  // namespace organ_collision
