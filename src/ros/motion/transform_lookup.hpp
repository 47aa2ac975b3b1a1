#pragma once

#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace organ_collision {

/// A value with the time it is of; zero: of any time (static transforms alone).
template <typename T>
struct Timed {
  T value;
  ros::Time stamp;
};

/// A value that TF may not have; then `why_not` says why. Never a stand-in.
template <typename T>
struct Lookup {
  std::optional<Timed<T>> found;
  std::string why_not;
};

/// T_target_source at a time; zero: the latest. Frames without leading slash.
Lookup<Eigen::Isometry3d> look_up(const tf2::BufferCore& buffer, const std::string& target,
                                  const std::string& source, ros::Time time);

}  // namespace organ_collision
