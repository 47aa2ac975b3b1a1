#include "transform_lookup.hpp"

#include <stdexcept>

#include "ros/interface/conversions.hpp"
#include "ros/interface/plain_text.hpp"

namespace organ_collision {

Lookup<Eigen::Isometry3d> look_up(const tf2::BufferCore& buffer, const std::string& target,
                                  const std::string& source, ros::Time time) {
  if (target == source) return {{{Eigen::Isometry3d::Identity(), time}}, ""};
  try {
    const geometry_msgs::TransformStamped found = buffer.lookupTransform(target, source, time);
    const Eigen::Isometry3d T_target_source = to_eigen(found.transform);
    if (!T_target_source.matrix().allFinite()) {
      return {std::nullopt, "transform from " + source + " to " + target + " is not finite"};
    }
    return {{{T_target_source, time.isZero() ? found.header.stamp : time}}, ""};
  } catch (const std::runtime_error& error) {  // From tf2, or from ros::Time for extreme stamps.
    // The text may be long: for a loop, tf2 lists all frames.
    return {std::nullopt, "no transform from " + source + " to " + target + ": " +
                              plain_text(error.what(), kLongestMessage)};
  }
}

}  // namespace organ_collision
