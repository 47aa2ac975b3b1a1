#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "liver_surface.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// The demo's markers for RViz, besides those of the collision node: the lit liver, and the
/// surfaces that fast tools sweep. Touched faces glow for a while, and the surfaces are shown for
/// the same time.
class LiverScene {
 public:
  /// `frame`: the liver's frame.
  LiverScene(std::string frame, std::vector<FaceIndices> faces);

  void touch(std::uint32_t face) { glow_.at(face) = 1.0; }
  void move_tool(const ShaftAxis& from, const ShaftAxis& to);

  /// `vertices`: x y z x y z ... [m]. `seconds`: time since the last call.
  visualization_msgs::MarkerArray markers(const ros::Time& stamp,
                                          const std::vector<float>& vertices, double seconds);

 private:
  visualization_msgs::Marker marker(const ros::Time& stamp, const std::string& what) const;

  std::string frame_;
  std::vector<FaceIndices> faces_;
  std::vector<double> glow_;         ///< of each face, from 1 when touched down to 0
  std::vector<ShaftMotion> sweeps_;  ///< of fast tools, since the last call
  int sweeps_shown_ = 0;
};

}  // namespace organ_collision
