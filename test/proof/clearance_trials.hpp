#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "trials.hpp"

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

/// A question for the clearance of a tool.
struct ClearanceTrial {
  ToolStep step;
  double margin;  ///< [m] 0: without a limit
};

/// A shaft at rest beside one face, as in make_trial(). `kind` is one of trial_kinds(). In some
/// trials, the margin differs from the distance by only 1e-3 to 1e-12 of it.
ClearanceTrial make_resting_shaft(std::size_t kind, Random& random);
/// A shaft that moves on one to three legs, or trembles on up to 20, with its trocar, past up to
/// three faces that move, too. `kind` is one of trial_kinds().
ClearanceTrial make_moving_shaft(std::size_t kind, Random& random);

/// The parts of links: sphere, box, cylinder, mesh.
const std::vector<std::string>& link_part_kinds();
/// A link at rest beside one face, as in make_link_trial(). `kind` is one of link_trial_kinds(),
/// and `part` one of link_part_kinds().
ClearanceTrial make_resting_link(std::size_t kind, std::size_t part, Random& random);
/// A link that moves and turns on one to three legs past up to three faces that move, too.
ClearanceTrial make_moving_link(std::size_t kind, std::size_t part, Random& random);

}  // namespace organ_collision::oracle
