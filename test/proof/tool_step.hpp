#pragma once

#include <Eigen/Geometry>
#include <iosfwd>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision::oracle {

/// A tool's step past an organ of a few faces. A path of one waypoint is a tool at rest.
struct ToolStep {
  TriangleMesh before, now;
  ToolPath path;
  double radius = 0.0;  ///< [m] of the shaft; 0: none
  std::vector<Link> links;

  bool at_rest() const { return path.size() == 1; }
};

/// A face at `fraction` of the step, when each vertex has moved linearly.
Triangle face_at(const ToolStep& step, std::size_t face, double fraction);
/// The tool at `fraction` of the step. Poses of links are interpolated by quaternions.
ToolPose pose_at(const ToolStep& step, double fraction);

/// Prints the whole step with 17 digits.
std::ostream& operator<<(std::ostream& out, const ToolStep& step);

}  // namespace organ_collision::oracle
