#include "path_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <queue>
#include <utility>

#include "geometry/concatenate.hpp"
#include "geometry/tool/leg_motion.hpp"

namespace organ_collision {
namespace {

using Sample = PathBuilder::Sample;

/// [m] Smaller deviations of an axis and smaller motions of a trocar count as rounding errors.
constexpr double kStraight = 1e-9;
/// [m] How far points of links may be from their motion, because samples were dropped; and as
/// much again, because joints were left out.
constexpr double kStraightLink = 5e-7;
/// [m] How far a path may be from the motion that TF interpolates.
constexpr double kExactPath = 1e-6;
/// [1] Larger differences of rotations are not rounding errors.
constexpr double kSameTurn = 1e-9;

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

/// [m] An upper bound of the distance between the places of a point of a link in two poses, for all
/// points within `reach` of the link's origin. A rotation by an angle moves such a point by at most
/// 2 reach sin(angle / 2). The Frobenius norm of the difference of the rotation matrices is sqrt(8)
/// sin(angle / 2).
double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double reach) {
  return (a.translation() - b.translation()).norm() +
         reach * std::sqrt(0.5) * (a.linear() - b.linear()).norm();
}

/// [m] An upper bound of how far a tool at the time of a sample is from a motion.
struct Deviation {
  double axis;   ///< for the two ends of the axis
  double links;  ///< for all points of the links
};

/// The motion between two samples, the later one being `to`. What is on the same joints in both of
/// them moves with these. Otherwise, the ends of the axis move linearly, and each link moves as a
/// RigidMotion. Joints that make no difference, except for rounding errors, are left out.
class MotionBetween {
 public:
  MotionBetween(const Sample& from, const Sample& to, const std::vector<double>& reaches);
  /// The deviation of a sample between both.
  Deviation deviation(const Sample& sample) const;
  /// The later waypoint.
  ToolWaypoint waypoint() const {
    return {to_.fraction, to_.pose.axis, to_.pose.links, arcs_, joints_};
  }

 private:
  double joints_deviation(std::size_t frame, const Sample& sample, double time) const;

  const Sample &from_, &to_;
  const std::vector<double>& reaches_;
  std::size_t of_shaft_ = 0;  ///< how many frames of the samples carry the shaft
  std::vector<ChainMotion> chains_;
  std::array<Eigen::Vector3d, 2> ends_;  ///< of the axis, in the frames that carry them [m]
  ShaftArcs arcs_;
  std::vector<ChainMotion> joints_;  ///< of the links; empty: they have none
};

MotionBetween::MotionBetween(const Sample& from, const Sample& to,
                             const std::vector<double>& reaches)
    : from_(from), to_(to), reaches_(reaches) {
  if (to.frames.empty() || from.frames.size() != to.frames.size()) return;
  for (std::size_t i = 0; i < to.frames.size(); ++i) {
    ChainMotion& chain = chains_.emplace_back();
    if (!to.frames[i].is_on_joints_of(from.frames[i])) continue;
    chain.chain = std::make_shared<JointChain>(from.frames[i].poses, to.frames[i].poses);
  }
  of_shaft_ = to.frames.size() - reaches.size();
  for (std::size_t end = 0; end < of_shaft_; ++end) {
    if (!chains_[end].chain) continue;
    const ShaftAxis& axis = to.pose.axis;
    ends_[end] = chains_[end].at(1.0).inverse() * (end == 0 ? axis.trocar : axis.tip);
    const ShaftArc arc(chains_[end], ends_[end]);
    if (arc.deviation() > kStraight) arcs_[end] = arc;
  }
  for (std::size_t i = 0; i < reaches.size(); ++i) {
    ChainMotion& chain = chains_[of_shaft_ + i];
    if (!chain.chain) continue;
    const Eigen::Isometry3d &before = from.pose.links[i], &after = to.pose.links[i];
    // A transform that came late has changed the pose after it was used.
    if (!chain.at(0.0).linear().isApprox(before.linear(), kSameTurn) ||
        !chain.at(1.0).linear().isApprox(after.linear(), kSameTurn)) {
      chain = {};
      continue;
    }
    if (chain.chain->is_one_joint()) continue;
    const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    if (chain.bounds(origin, reaches[i]).deviation +
            RigidMotion(before, after).chord_deviation(origin, reaches[i]) <=
        kStraightLink) {
      continue;
    }
    joints_.resize(reaches.size());
    joints_[i] = chain;
  }
}

/// A joint that is off by a distance and an angle moves a point by at most the distance, and the
/// angle times the distance of the point. The sum over all joints bounds the deviation also at
/// other times than that of the sample, when the deviations of two joints add up that compensate
/// each other now.
double MotionBetween::joints_deviation(std::size_t frame, const Sample& sample, double time) const {
  const FrameJoints &from = from_.frames[frame], &to = to_.frames[frame];
  const FrameJoints& joints = sample.frames[frame];
  const bool is_end = frame < of_shaft_;
  const double reach = is_end ? 0.0 : reaches_[frame - of_shaft_];
  Eigen::Vector3d point = is_end ? ends_[frame] : Eigen::Vector3d(Eigen::Vector3d::Zero());
  double deviation = 0.0;
  for (std::size_t i = joints.poses.size(); i-- > 0;) {
    deviation +=
        distance(Joint(from.poses[i], to.poses[i]).at(time), joints.poses[i], point.norm() + reach);
    point = joints.poses[i] * point;
  }
  return deviation;
}

Deviation MotionBetween::deviation(const Sample& sample) const {
  const double time = (sample.fraction - from_.fraction) / (to_.fraction - from_.fraction);
  const auto is_on_joints = [&](std::size_t frame) {
    return frame < chains_.size() && chains_[frame].chain && frame < sample.frames.size() &&
           sample.frames[frame].is_on_joints_of(from_.frames[frame]);
  };
  Deviation deviation{0.0, 0.0};
  const ShaftAxis now = ShaftMotion{from_.pose.axis, to_.pose.axis, arcs_}.at(time);
  const ShaftAxis& axis = sample.pose.axis;
  const bool has_shaft = of_shaft_ > 0;
  const double of_trocar = has_shaft && is_on_joints(0) ? joints_deviation(0, sample, time)
                                                        : (now.trocar - axis.trocar).norm();
  const double of_tip = has_shaft && is_on_joints(1) ? joints_deviation(1, sample, time)
                                                     : (now.tip - axis.tip).norm();
  deviation.axis = std::max(of_trocar, of_tip);
  for (std::size_t i = 0; i < reaches_.size(); ++i) {
    const std::size_t frame = of_shaft_ + i;
    const double of_link = is_on_joints(frame)
                               ? joints_deviation(frame, sample, time)
                               : distance(RigidMotion(from_.pose.links[i], to_.pose.links[i],
                                                      joints_.empty() ? ChainMotion{} : joints_[i])
                                              .at(time),
                                          sample.pose.links[i], reaches_[i]);
    deviation.links = std::max(deviation.links, of_link);
  }
  return deviation;
}

/// The motion between the waypoints `begin` and `end`, and the waypoint in between that deviates
/// most from it. Waypoints are indices into the path.
struct Leg {
  std::size_t begin, end, farthest;
  double deviation = 0.0;  ///< [m] of the waypoint `farthest`

  bool operator<(const Leg& other) const { return deviation < other.deviation; }
};

Leg leg_between(const std::vector<Sample>& path, const std::vector<double>& reaches,
                std::size_t begin, std::size_t end) {
  Leg leg{begin, end, begin};
  const MotionBetween motion(path[begin], path[end], reaches);
  for (std::size_t i = begin + 1; i < end; ++i) {
    const Deviation deviation = motion.deviation(path[i]);
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
ToolPath path_of(const std::vector<Sample>& samples, const std::vector<double>& reaches) {
  const Sample& first = samples.front();
  ToolPath path = {{first.fraction, first.pose.axis, first.pose.links}};
  for (std::size_t i = 1; i < samples.size(); ++i) {
    path.push_back(MotionBetween(samples[i - 1], samples[i], reaches).waypoint());
  }
  rest_trocar(path);
  return path;
}

}  // namespace

PathBuilder::PathBuilder(const std::vector<Link>& links, const ToolPose& begin,
                         std::vector<FrameJoints> frames)
    : path_{{0.0, begin, std::move(frames)}} {
  reaches_.reserve(links.size());
  for (const Link& link : links) reaches_.push_back(reach(link));
}

void PathBuilder::add(double fraction, const ToolPose& pose, std::vector<FrameJoints> frames) {
  Sample next{fraction, pose, std::move(frames)};
  const std::size_t size = path_.size();
  if (size > 1) {
    const Deviation deviation =
        MotionBetween(path_[size - 2], next, reaches_).deviation(path_[size - 1]);
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

SampledPath PathBuilder::take(std::size_t legs_max) {
  if (path_.size() <= legs_max + 1) return {path_of(path_, reaches_)};
  std::priority_queue<Leg> legs;
  legs.push(leg_between(path_, reaches_, 0, path_.size() - 1));
  std::vector<std::size_t> kept = {0, path_.size() - 1};
  while (legs.size() < legs_max && legs.top().deviation > 0.0) {
    const Leg leg = legs.top();
    legs.pop();
    legs.push(leg_between(path_, reaches_, leg.begin, leg.farthest));
    legs.push(leg_between(path_, reaches_, leg.farthest, leg.end));
    kept.push_back(leg.farthest);
  }
  std::sort(kept.begin(), kept.end());
  SampledPath built{{}, path_.size() - kept.size(), legs.top().deviation};
  if (built.deviation_cut > kExactPath) {
    built.unknown = concatenate(built.samples_cut,
                                " of the tool's poses in this step were left out "
                                "(motion_samples_max), the farthest is ",
                                1e3 * built.deviation_cut, " mm from the tested path");
  }
  std::vector<Sample> samples;
  for (const std::size_t sample : kept) samples.push_back(std::move(path_[sample]));
  built.path = path_of(samples, reaches_);
  return built;
}

}  // namespace organ_collision
