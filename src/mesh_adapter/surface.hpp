#pragma once

#include <ros/time.h>

#include <cstdint>
#include <string>
#include <vector>

namespace organ_collision {

/// An organ's surface as some message had it. Not necessarily a legal one: the collision node
/// judges that.
struct Surface {
  std::string frame;                     ///< empty: the message named none
  ros::Time stamp;                       ///< zero: it had none
  std::vector<float> vertices;           ///< x y z x y z ... [m]
  std::vector<std::uint32_t> triangles;  ///< three vertex indices a face

  /// The organ is gone.
  bool empty() const { return vertices.empty() && triangles.empty(); }
};

}  // namespace organ_collision
