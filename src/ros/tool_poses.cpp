#include "organ_collision/ros/tool_poses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/ros/path_builder.hpp"

namespace organ_collision {
namespace {

/// The times that some transforms are of, without those of any time.
struct StampRange {
  ros::Time earliest, latest;  ///< zero: all are of any time

  void add(ros::Time stamp) {
    if (stamp.isZero()) return;
    earliest = earliest.isZero() ? stamp : std::min(earliest, stamp);
    latest = std::max(latest, stamp);
  }
};

std::string without_link(const Tool& tool, std::size_t link, const std::string& why_not) {
  const std::string& joint = tool.joints[link];
  return "link '" + tool.links[link].name + "' of tool '" + tool.parameters.name + "'" +
         (joint.empty() ? "" : " (is joint '" + joint + "' published?)") + ": " + why_not;
}

bool is_near(const Eigen::Vector3d& point) {
  return (point.array().abs() <= tolerance::kFarthest).all();
}

bool is_near(const ToolPose& pose) {
  return is_near(pose.axis.trocar) && is_near(pose.axis.tip) &&
         std::all_of(pose.links.begin(), pose.links.end(),
                     [](const auto& link) { return is_near(link.translation()); });
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

Lookup<ToolPose> ToolPoses::pose(const Tool& tool, const std::string& organ_frame,
                                 ros::Time time) const {
  const ToolParameters& parameters = tool.parameters;
  ToolPose pose{{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}};
  StampRange stamps;
  const auto look_up_frame = [&](const std::string& frame) {
    auto lookup = look_up(buffer_, organ_frame, frame, time);
    if (lookup.found) stamps.add(lookup.found->stamp);
    return lookup;
  };
  if (parameters.has_shaft()) {
    const auto trocar = look_up_frame(parameters.trocar_frame);
    if (!trocar.found) return {std::nullopt, trocar.why_not};
    const auto tip = look_up_frame(parameters.tip_frame);
    if (!tip.found) return {std::nullopt, unless_silent(parameters, tip.why_not)};
    pose.axis = {trocar.found->value.translation(), tip.found->value.translation()};
  }
  pose.links.reserve(tool.links.size());
  for (std::size_t i = 0; i < tool.links.size(); ++i) {
    const auto link = look_up_frame(parameters.link_frame(tool.links[i].name));
    if (!link.found) {
      return {std::nullopt, unless_silent(parameters, without_link(tool, i, link.why_not))};
    }
    pose.links.push_back(link.found->value);
  }
  // Each was the latest of its own; a tool is made of parts at the same time.
  if (stamps.earliest != stamps.latest) return this->pose(tool, organ_frame, stamps.earliest);
  return {{{std::move(pose), stamps.earliest}}, ""};
}

std::string ToolPoses::unless_silent(const ToolParameters& tool, const std::string& why_not) const {
  const bool silent = !tool.tip_pose_topic.empty() && stamps_.count(tool.name) == 0;
  return silent ? "no pose came on " + tool.tip_pose_topic : why_not;
}

SampledPath ToolPoses::path(const Tool& tool, const std::string& organ_frame,
                            const Timed<ToolPose>& from, const Timed<ToolPose>& to) const {
  const double duration = nanoseconds(from.stamp, to.stamp);
  SampledPath sampled;
  PathBuilder path(tool.links, from.value);
  for (const ros::Time time :
       sample_times(tool.parameters, from.stamp, to.stamp, sampled.samples_cut)) {
    // One that cannot be evaluated is no reason to refuse all others.
    if (const auto between = pose(tool, organ_frame, time);
        between.found && is_near(between.found->value)) {
      path.add(nanoseconds(from.stamp, time) / duration, between.found->value);
    }
  }
  path.add(1.0, to.value);
  sampled.path = path.take();
  return sampled;
}

}  // namespace organ_collision
