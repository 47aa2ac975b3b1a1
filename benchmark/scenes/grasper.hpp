#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision::bench {

/// A laparoscopic grasper: a shaft of 5 mm, and as links a wrist (a cylinder) and two jaws of 20 mm
/// (closed meshes of 500 faces).
struct Grasper {
  static constexpr double kRadius = 0.0025;  ///< [m] of the shaft
  static std::vector<Link> make_links();

  /// Where it is with this axis when each jaw is open by `opening` [rad].
  static ToolWaypoint place(double fraction, const ShaftAxis& axis, double opening);
};

}  // namespace organ_collision::bench
