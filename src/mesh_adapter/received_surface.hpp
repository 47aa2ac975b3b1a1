#pragma once

#include <ros/time.h>

#include <cstdint>
#include <string>
#include <vector>

namespace organ_collision {

/// An organ's surface as a message described it. It may be illegal: the collision node checks it.
struct ReceivedSurface {
  std::string frame;                     ///< empty: the message has none
  ros::Time stamp;                       ///< zero: the message has none
  std::vector<float> vertices;           ///< x y z x y z ... [m]
  std::vector<std::uint32_t> triangles;  ///< three vertex indices for each face

  /// Whether the organ was removed.
  bool empty() const { return vertices.empty() && triangles.empty(); }
};

}  // namespace organ_collision
