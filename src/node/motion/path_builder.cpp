#include "path_builder.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "geometry/concatenate.hpp"
#include "geometry/tool/leg_motion.hpp"

namespace organ_collision {
namespace {

using Sample = PathBuilder::Sample;

/// [m] Smaller deviations of an axis and smaller motions of a trocar count as rounding errors.
constexpr double kStraight = 1e-9;
/// [m] Smaller deviations of the points of links count as rounding errors.
constexpr double kStraightLink = 1e-6;

/// [m] An upper bound of the distance of the link's points from the origin of the link's frame.
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

/// [m] An upper bound of the distance between the places of a point of a link in two poses, for all
/// points within `reach` of the link's origin. A rotation by an angle moves such a point by at most
/// 2 reach sin(angle / 2). The Frobenius norm of the difference of the rotation matrices is sqrt(8)
/// sin(angle / 2).
double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double reach) {
  return (a.translation() - b.translation()).norm() +
         reach * std::sqrt(0.5) * (a.linear() - b.linear()).norm();
}

/// [m] The distance between a waypoint and a straight motion at the time of the waypoint.
struct Deviation {
  double axis;   ///< the larger deviation of the two ends of the axis
  double links;  ///< an upper bound for all points of the links
};

/// The arcs on which the ends of the axis move between two poses. An arc that is straight except
/// for rounding errors is straight.
ShaftArcs arcs_between(const ToolPose& from, const ToolPose& to) {
  ShaftArcs arcs;
  for (std::size_t end = 0; end < arcs.size(); ++end) {
    if (from.carriers[end].arm.isZero(0.0)) continue;
    arcs[end] = from.carriers[end].arc_to(to.carriers[end]);
    if (arcs[end].deviation() <= kStraight) arcs[end] = {};
  }
  return arcs;
}

/// The deviation of a sample from the straight motion between `from` and `to`: the ends of the axis
/// move linearly or on arcs, and each link moves as a RigidMotion. `to` is later than `from`.
Deviation deviation_of(const Sample& sample, const Sample& from, const Sample& to,
                       const std::vector<double>& reaches) {
  const double time = (sample.fraction - from.fraction) / (to.fraction - from.fraction);
  const ShaftMotion shaft{from.pose.axis, to.pose.axis, arcs_between(from.pose, to.pose)};
  Deviation deviation{distance(shaft.at(time), sample.pose.axis), 0.0};
  for (std::size_t i = 0; i < reaches.size(); ++i) {
    const Eigen::Isometry3d straight = RigidMotion(from.pose.links[i], to.pose.links[i]).at(time);
    deviation.links =
        std::max(deviation.links, distance(straight, sample.pose.links[i], reaches[i]));
  }
  return deviation;
}

/// The straight motion between the waypoints `begin` and `end`, and the waypoint in between that
/// deviates most from it. Waypoints are indices into the path.
struct Leg {
  std::size_t begin, end, farthest;
  double deviation = 0.0;  ///< [m] of the waypoint `farthest`

  bool operator<(const Leg& other) const { return deviation < other.deviation; }
};

Leg straight_leg(const std::vector<Sample>& path, const std::vector<double>& reaches,
                 std::size_t begin, std::size_t end) {
  Leg leg{begin, end, begin};
  for (std::size_t i = begin + 1; i < end; ++i) {
    const Deviation deviation = deviation_of(path[i], path[begin], path[end], reaches);
    const double most = std::max(deviation.axis, deviation.links);
    if (most > leg.deviation) {
      leg.deviation = most;
      leg.farthest = i;
    }
  }
  return leg;
}

/// If the trocar moves only by rounding errors, lets it rest, because the viewing volumes for a
/// resting trocar are tighter.
void rest_trocar(ToolPath& path) {
  const Eigen::Vector3d trocar = path.back().axis.trocar;
  const auto is_there = [&](const ToolWaypoint& waypoint) {
    return (waypoint.axis.trocar - trocar).norm() <= kStraight &&
           waypoint.arcs[0].deviation() == 0.0;
  };
  if (!std::all_of(path.begin(), path.end(), is_there)) return;
  for (ToolWaypoint& waypoint : path) waypoint.axis.trocar = trocar;
}

/// The path through the samples.
ToolPath path_of(std::vector<Sample> samples) {
  ToolPath path;
  for (Sample& sample : samples) {
    path.push_back({sample.fraction, sample.pose.axis, std::move(sample.pose.links)});
    if (path.size() < 2) continue;
    path.back().arcs = arcs_between(samples[path.size() - 2].pose, sample.pose);
  }
  rest_trocar(path);
  return path;
}

}  // namespace

PathBuilder::PathBuilder(const std::vector<Link>& links, const ToolPose& begin)
    : path_{{0.0, begin}} {
  reaches_.reserve(links.size());
  for (const Link& link : links) reaches_.push_back(reach(link));
}

void PathBuilder::add(double fraction, const ToolPose& pose) {
  Sample next{fraction, pose};
  const std::size_t size = path_.size();
  if (size > 1) {
    const Deviation deviation = deviation_of(path_[size - 1], path_[size - 2], next, reaches_);
    // Each dropped sample changes the leg by at most its own deviation, so the sum of the
    // deviations bounds the change. The sum counts multiples of the tolerances.
    dropped_deviation_ += std::max(deviation.axis / kStraight, deviation.links / kStraightLink);
    if (dropped_deviation_ <= 1.0) {
      path_.back() = std::move(next);
      return;
    }
  }
  dropped_deviation_ = 0.0;
  path_.push_back(std::move(next));
}

bool PathBuilder::is_far(const ToolPose& from, const ToolPose& to) const {
  constexpr double kLeastRadius = 0.01;  // [m]
  double moved = distance(from.axis, to.axis);
  for (std::size_t i = 0; i < reaches_.size(); ++i) {
    moved = std::max(moved, distance(from.links[i], to.links[i], reaches_[i]));
  }
  // A chord is about chord^2 / (8 * radius) away from its arc.
  return moved * moved > 8.0 * kLeastRadius * kStraightLink;
}

bool PathBuilder::is_bent(const ToolPose& from, const ToolPose& half_way,
                          const ToolPose& to) const {
  const Deviation deviation = deviation_of({0.5, half_way}, {0.0, from}, {1.0, to}, reaches_);
  return std::max(deviation.axis, deviation.links) > kStraightLink;
}

SampledPath PathBuilder::take(std::size_t legs_max) {
  if (path_.size() <= legs_max + 1) return {path_of(std::move(path_))};
  std::priority_queue<Leg> legs;
  legs.push(straight_leg(path_, reaches_, 0, path_.size() - 1));
  std::vector<std::size_t> kept = {0, path_.size() - 1};
  while (legs.size() < legs_max && legs.top().deviation > 0.0) {
    const Leg leg = legs.top();
    legs.pop();
    legs.push(straight_leg(path_, reaches_, leg.begin, leg.farthest));
    legs.push(straight_leg(path_, reaches_, leg.farthest, leg.end));
    kept.push_back(leg.farthest);
  }
  std::sort(kept.begin(), kept.end());
  SampledPath built{{}, path_.size() - kept.size(), legs.top().deviation};
  if (built.deviation_cut > kStraightLink) {
    built.unknown = concatenate(built.samples_cut,
                                " of the tool's poses in this step were left out "
                                "(motion_samples_max), the farthest is ",
                                1e3 * built.deviation_cut, " mm from the tested path");
  }
  std::vector<Sample> samples;
  for (const std::size_t sample : kept) samples.push_back(std::move(path_[sample]));
  built.path = path_of(std::move(samples));
  return built;
}

}  // namespace organ_collision
