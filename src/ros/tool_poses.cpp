#include "organ_collision/ros/tool_poses.hpp"

#include <algorithm>
#include <cmath>

namespace organ_collision {
namespace {

/// The earlier of two times; zero is of any time.
ros::Time common_time(ros::Time a, ros::Time b) {
  if (a.isZero()) return b;
  return b.isZero() ? a : std::min(a, b);
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
  const double duration = (to.stamp - from.stamp).toSec();
  const double wanted = std::max(1.0, std::ceil(duration / sampling_.sample_sec - 1e-6));
  const int legs = static_cast<int>(std::min<double>(wanted, sampling_.samples_max));

  SampledPath sampled;
  sampled.samples_cut = static_cast<std::size_t>(wanted - legs);
  sampled.path.push_back({0.0, from.value});
  for (int i = 1; i < legs; ++i) {
    const double fraction = static_cast<double>(i) / legs;
    const ros::Time time = from.stamp + ros::Duration(fraction * duration);
    if (const auto between = axis(tool, organ_frame, time); between.found) {
      sampled.path.push_back({fraction, between.found->value});
    }
  }
  sampled.path.push_back({1.0, to.value});
  return sampled;
}

}  // namespace organ_collision
