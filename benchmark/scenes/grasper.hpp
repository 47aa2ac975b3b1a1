#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision::bench {

/// A laparoscopic grasper: a shaft of 5 mm diameter and three links, a wrist (a cylinder) and two
/// jaws of 20 mm length (closed meshes of 500 faces each).
struct Grasper {
  static constexpr double kRadius = 0.0025;  ///< [m] radius of the shaft
  static std::vector<Link> make_links();

  /// The grasper with this shaft axis and each jaw open by `opening` [rad].
  static ToolWaypoint place(double fraction, const ShaftAxis& axis, double opening);
};

}  // namespace organ_collision::bench
