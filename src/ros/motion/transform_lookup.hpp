#pragma once

#include <ros/time.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "transform_buffer.hpp"

namespace organ_collision {

/// A value and its time. Time zero: it is valid at any time, because all its transforms are static.
template <typename T>
struct Timed {
  T value;
  ros::Time stamp;
};

/// A value, or why TF does not have it. There is never a stand-in value.
template <typename T>
struct Lookup {
  std::optional<Timed<T>> found;
  std::string why_not;
  bool is_late = false;  ///< the transforms are known, but the newest is older than the time
};

/// T_target_source at a time; time zero means the latest common time. Transforms that are not
/// believed any more (TransformBuffer::believed_until) count as not yet known. The frame names must
/// have no leading slash.
Lookup<Eigen::Isometry3d> look_up(const TransformBuffer& buffer, const std::string& target,
                                  const std::string& source, ros::Time time);

/// Whether TF has that transform. Costs less than a look_up() that finds none, because no error is
/// put into words.
bool has_transform(const TransformBuffer& buffer, const std::string& target,
                   const std::string& source, ros::Time time);

/// A frame, and the stamp of the newest transform to its parent.
struct NewestTransform {
  std::string frame;
  ros::Time stamp;
};

/// Of the frames that carry `frame`, the one whose newest transform is the oldest; a static one has
/// no age. These are `frame` and those above it, without those that also carry each of `others`:
/// what they do, moves none against the other. Empty if nothing but static transforms is left.
std::optional<NewestTransform> oldest_transform(const tf2::BufferCore& buffer,
                                                const std::string& frame,
                                                const std::vector<std::string>& others);

}  // namespace organ_collision
