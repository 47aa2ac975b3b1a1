#include "organ_collision/ros/tool_poses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace organ_collision {
namespace {

/// [m] A bend of a path, or a way of a trocar, by less is none.
constexpr double kStraight = 1e-9;

/// The earlier of two times; zero is of any time.
ros::Time common_time(ros::Time a, ros::Time b) {
  if (a.isZero()) return b;
  return b.isZero() ? a : std::min(a, b);
}

/// How far `b` is from the straight way from `a` to `c`, at its time.
double bend(const ShaftWaypoint& a, const ShaftWaypoint& b, const ShaftWaypoint& c) {
  const ShaftMotion motion{a.axis, c.axis};
  const ShaftAxis straight = motion.at((b.fraction - a.fraction) / (c.fraction - a.fraction));
  return std::max((straight.trocar - b.axis.trocar).norm(), (straight.tip - b.axis.tip).norm());
}

/// A path without the waypoints that add nothing: every leg costs a query of its own, and between
/// two transforms TF interpolates, mostly in a straight line.
class PathBuilder {
 public:
  PathBuilder(ShaftPath& path, const ShaftAxis& begin) : path_(path) { path_ = {{0.0, begin}}; }

  void add(const ShaftWaypoint& next) {
    const std::size_t size = path_.size();
    const double added = size > 1 ? bend(path_[size - 2], path_[size - 1], next) : 0.0;
    // Each waypoint left out turns the leg by no more than its own bend: the sum bounds them all.
    if (size > 1 && bends_left_out_ + added <= kStraight) {
      bends_left_out_ += added;
      path_.back() = next;
    } else {
      bends_left_out_ = 0.0;
      path_.push_back(next);
    }
  }

 private:
  ShaftPath& path_;
  double bends_left_out_ = 0.0;  ///< [m] of the last leg
};

/// A trocar that moves by rounding alone is at rest, for which viewing volumes are tighter.
void rest_trocar(ShaftPath& path) {
  const Eigen::Vector3d trocar = path.back().axis.trocar;
  const auto is_there = [&](const ShaftWaypoint& waypoint) {
    return (waypoint.axis.trocar - trocar).norm() <= kStraight;
  };
  if (!std::all_of(path.begin(), path.end(), is_there)) return;
  for (ShaftWaypoint& waypoint : path) waypoint.axis.trocar = trocar;
}

}  // namespace

Lookup<ShaftAxis> ToolPoses::axis(const ToolParameters& tool, const std::string& organ_frame,
                                  ros::Time time) const {
  const auto trocar = look_up(buffer_, organ_frame, tool.trocar_frame, time);
  if (!trocar.found) return {std::nullopt, trocar.why_not};
  const auto tip = look_up(buffer_, organ_frame, tool.tip_frame, time);
  if (!tip.found) return {std::nullopt, tip.why_not};
  const ros::Time both = common_time(trocar.found->stamp, tip.found->stamp);
  // Each was the latest of its own; the axis is made of two points of the same time.
  if (time.isZero() && !both.isZero() && trocar.found->stamp != tip.found->stamp) {
    return axis(tool, organ_frame, both);
  }
  return {{{{trocar.found->value.translation(), tip.found->value.translation()}, both}}, ""};
}

SampledPath ToolPoses::path(const ToolParameters& tool, const std::string& organ_frame,
                            const Timed<ShaftAxis>& from, const Timed<ShaftAxis>& to) const {
  // Whole nanoseconds: ros::Duration would overflow at absurd stamps.
  const auto begin = static_cast<std::int64_t>(from.stamp.toNSec());
  const auto duration = static_cast<std::int64_t>(to.stamp.toNSec()) - begin;
  const double wanted =
      std::max(1.0, std::ceil(1e-9 * static_cast<double>(duration) / sampling_.sample_sec - 1e-6));
  const int legs = static_cast<int>(std::min<double>(wanted, sampling_.samples_max));

  SampledPath sampled;
  sampled.samples_cut = static_cast<std::size_t>(wanted - legs);
  PathBuilder path(sampled.path, from.value);
  for (int i = 1; i < legs; ++i) {
    const std::int64_t elapsed = duration / legs * i;
    ros::Time time;
    time.fromNSec(static_cast<std::uint64_t>(begin + elapsed));
    if (const auto between = axis(tool, organ_frame, time); between.found) {
      path.add(
          {static_cast<double>(elapsed) / static_cast<double>(duration), between.found->value});
    }
  }
  path.add({1.0, to.value});
  rest_trocar(sampled.path);
  return sampled;
}

}  // namespace organ_collision
