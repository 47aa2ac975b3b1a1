#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_surface.hpp"

namespace organ_collision::bench {

/// Independent motions of one tool, as a planner asks about them. Each path has two waypoints.
struct MotionSet {
  double radius;            ///< [m] of the tool's shaft
  std::vector<Link> links;  ///< of the tool; empty if it is only a shaft
  std::vector<ToolPath> paths;
};

/// A shaft that pierces the organ. Its radius and motion are those of SceneScale.
MotionSet shaft_motions(const OrganSurface& organ, std::size_t count);

/// The Grasper, of the same size for each organ. Its shaft ends above the organ, and its jaws reach
/// into it. In a motion it moves sideways by 1 mm, and each jaw closes by 0.02 rad.
MotionSet grasper_motions(const OrganSurface& organ, std::size_t count);

/// The motions of the tool "shaft" or "grasper". Throws std::invalid_argument for any other.
MotionSet motions_of(const std::string& tool, const OrganSurface& organ, std::size_t count);

}  // namespace organ_collision::bench
