#include "path_builder.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace organ_collision {
namespace {

/// [m] An upper bound for the distance of the link's points from its origin.
double reach(const Link& link) {
  double farthest = 0.0;
  for (const LinkPart& part : link.parts) {
    const OrientedBox& box = part.bounds;
    const Eigen::Vector3d center = box.axes.transpose() * box.center;
    farthest = std::max(farthest, (center.cwiseAbs() + box.half_size).norm() + part.radius);
  }
  return farthest;
}

/// [m] The larger of the distances between corresponding ends of two axes.
double distance(const ShaftAxis& a, const ShaftAxis& b) {
  return std::max((a.trocar - b.trocar).norm(), (a.tip - b.tip).norm());
}

/// [m] An upper bound for the distance between the positions of a point in two poses, for all
/// points within `reach` of the origin. A rotation by an angle moves such a point by at most
/// 2 reach sin(angle / 2). The Frobenius norm of the difference of the rotation matrices is
/// sqrt(8) sin(angle / 2).
double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double reach) {
  return (a.translation() - b.translation()).norm() +
         reach * std::sqrt(0.5) * (a.linear() - b.linear()).norm();
}

}  // namespace

StraightMotion::StraightMotion(const ToolWaypoint& from, const ToolWaypoint& to)
    : begin(from.fraction), duration(to.fraction - from.fraction), axis{from.axis, to.axis} {
  links.reserve(from.links.size());
  for (std::size_t i = 0; i < from.links.size(); ++i) {
    links.emplace_back(from.links[i], to.links[i]);
  }
}

PathDeviation::PathDeviation(const std::vector<Link>& links) {
  reaches_.reserve(links.size());
  for (const Link& link : links) reaches_.push_back(reach(link));
}

Deviation PathDeviation::operator()(const ToolWaypoint& waypoint,
                                    const StraightMotion& motion) const {
  const double time = (waypoint.fraction - motion.begin) / motion.duration;
  Deviation deviation{distance(motion.axis.at(time), waypoint.axis), 0.0};
  for (std::size_t i = 0; i < reaches_.size(); ++i) {
    deviation.links = std::max(deviation.links,
                               distance(motion.links[i].at(time), waypoint.links[i], reaches_[i]));
  }
  return deviation;
}

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

namespace {

/// The straight motion between two waypoints, and the waypoint in between that deviates most.
struct Leg {
  std::size_t begin, end, farthest;
  double deviation = 0.0;  ///< [m]

  bool operator<(const Leg& other) const { return deviation < other.deviation; }
};

Leg straight_leg(const ToolPath& path, const PathDeviation& deviation, std::size_t begin,
                 std::size_t end) {
  Leg leg{begin, end, begin};
  const StraightMotion motion(path[begin], path[end]);
  for (std::size_t i = begin + 1; i < end; ++i) {
    const double most = deviation(path[i], motion).most();
    if (most > leg.deviation) {
      leg.deviation = most;
      leg.farthest = i;
    }
  }
  return leg;
}

}  // namespace

SimplifiedPath simplify_path(ToolPath path, const PathDeviation& deviation, std::size_t legs_max) {
  if (path.size() <= legs_max + 1) return {std::move(path)};
  std::priority_queue<Leg> legs;
  legs.push(straight_leg(path, deviation, 0, path.size() - 1));
  std::vector<std::size_t> kept = {0, path.size() - 1};
  while (legs.size() < legs_max && legs.top().deviation > 0.0) {
    const Leg leg = legs.top();
    legs.pop();
    legs.push(straight_leg(path, deviation, leg.begin, leg.farthest));
    legs.push(straight_leg(path, deviation, leg.farthest, leg.end));
    kept.push_back(leg.farthest);
  }
  std::sort(kept.begin(), kept.end());
  SimplifiedPath result{{}, path.size() - kept.size(), legs.top().deviation};
  for (const std::size_t waypoint : kept) result.path.push_back(std::move(path[waypoint]));
  return result;
}

}  // namespace organ_collision
