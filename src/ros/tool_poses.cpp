#include "organ_collision/ros/tool_poses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "organ_collision/geometry/tolerances.hpp"

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
double bend(const ToolWaypoint& a, const ToolWaypoint& b, const ToolWaypoint& c) {
  const ShaftMotion motion{a.axis, c.axis};
  const ShaftAxis straight = motion.at((b.fraction - a.fraction) / (c.fraction - a.fraction));
  return std::max((straight.trocar - b.axis.trocar).norm(), (straight.tip - b.axis.tip).norm());
}

/// A path without the waypoints that add nothing: every leg costs a query of its own, and between
/// two transforms TF interpolates, mostly in a straight line.
class PathBuilder {
 public:
  PathBuilder(ToolPath& path, const ShaftAxis& begin) : path_(path) { path_ = {{0.0, begin}}; }

  void add(const ToolWaypoint& next) {
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
  ToolPath& path_;
  double bends_left_out_ = 0.0;  ///< [m] of the last leg
};

/// A trocar that moves by rounding alone is at rest, for which viewing volumes are tighter.
void rest_trocar(ToolPath& path) {
  const Eigen::Vector3d trocar = path.back().axis.trocar;
  const auto is_there = [&](const ToolWaypoint& waypoint) {
    return (waypoint.axis.trocar - trocar).norm() <= kStraight;
  };
  if (!std::all_of(path.begin(), path.end(), is_there)) return;
  for (ToolWaypoint& waypoint : path) waypoint.axis.trocar = trocar;
}

bool is_near(const ShaftAxis& axis) {
  return (axis.trocar.array().abs() <= tolerance::kFarthest).all() &&
         (axis.tip.array().abs() <= tolerance::kFarthest).all();
}

/// Whole nanoseconds: ros::Duration would overflow at absurd stamps.
std::int64_t elapsed(ros::Time from, ros::Time to) {
  return static_cast<std::int64_t>(to.toNSec()) - static_cast<std::int64_t>(from.toNSec());
}
double nanoseconds(ros::Time from, ros::Time to) { return static_cast<double>(elapsed(from, to)); }

/// So many times, evenly spaced between two.
std::vector<ros::Time> even_times(ros::Time from, ros::Time to, std::size_t count) {
  const std::int64_t step = elapsed(from, to) / (static_cast<std::int64_t>(count) + 1);
  std::vector<ros::Time> times(count);
  std::uint64_t time = from.toNSec();
  for (ros::Time& between : times) between.fromNSec(time += static_cast<std::uint64_t>(step));
  return times;
}

/// Leaves `count` of them, spread evenly.
void thin_out(std::vector<ros::Time>& times, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) times[i] = times[i * times.size() / count];
  times.resize(count);
}

}  // namespace

void ToolPoses::add_sample(const ToolParameters& tool, ros::Time stamp) {
  stamps_[tool.name].add(stamp);
}

/// Poses that came as messages before those in between. `cut`: how many samples there would be more
/// without samples_max.
std::vector<ros::Time> ToolPoses::sample_times(const ToolParameters& tool, ros::Time from,
                                               ros::Time to, std::size_t& cut) const {
  const auto most = static_cast<std::size_t>(sampling_.samples_max - 1);
  std::vector<ros::Time> times;
  if (const auto streamed = stamps_.find(tool.name); streamed != stamps_.end()) {
    times = streamed->second.between(from, to);
  }
  if (times.size() > most) {
    cut = times.size() - most;
    thin_out(times, most);
    return times;
  }
  const double wanted =
      std::max(0.0, std::ceil(1e-9 * nanoseconds(from, to) / sampling_.sample_sec - 1e-6) - 1.0);
  const double count = std::min(wanted, static_cast<double>(most - times.size()));
  // Between poses that come as often, TF knows nothing more.
  if (times.empty()) cut = static_cast<std::size_t>(wanted - count);
  const auto even = even_times(from, to, static_cast<std::size_t>(count));
  times.insert(times.end(), even.begin(), even.end());
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

Lookup<ShaftAxis> ToolPoses::axis(const ToolParameters& tool, const std::string& organ_frame,
                                  ros::Time time) const {
  const auto trocar = look_up(buffer_, organ_frame, tool.trocar_frame, time);
  if (!trocar.found) return {std::nullopt, trocar.why_not};
  const auto tip = look_up(buffer_, organ_frame, tool.tip_frame, time);
  if (!tip.found) {
    const bool silent = !tool.tip_pose_topic.empty() && stamps_.count(tool.name) == 0;
    return {std::nullopt, silent ? "no pose came on " + tool.tip_pose_topic : tip.why_not};
  }
  const ros::Time both = common_time(trocar.found->stamp, tip.found->stamp);
  // Each was the latest of its own; the axis is made of two points of the same time.
  if (time.isZero() && !both.isZero() && trocar.found->stamp != tip.found->stamp) {
    return axis(tool, organ_frame, both);
  }
  return {{{{trocar.found->value.translation(), tip.found->value.translation()}, both}}, ""};
}

SampledPath ToolPoses::path(const ToolParameters& tool, const std::string& organ_frame,
                            const Timed<ShaftAxis>& from, const Timed<ShaftAxis>& to) const {
  const double duration = nanoseconds(from.stamp, to.stamp);
  SampledPath sampled;
  PathBuilder path(sampled.path, from.value);
  for (const ros::Time time : sample_times(tool, from.stamp, to.stamp, sampled.samples_cut)) {
    // One that cannot be evaluated is no reason to refuse all others.
    if (const auto between = axis(tool, organ_frame, time);
        between.found && is_near(between.found->value)) {
      path.add({nanoseconds(from.stamp, time) / duration, between.found->value});
    }
  }
  path.add({1.0, to.value});
  rest_trocar(sampled.path);
  return sampled;
}

}  // namespace organ_collision
