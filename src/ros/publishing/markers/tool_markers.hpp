#pragma once

#include <string>

#include "marker_sheet.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// A mesh of a link with more faces is drawn as its bounding box, because the tools are sent with
/// each picture.
inline constexpr std::size_t kMostFacesOfTool = 5000;

/// Adds the tool at a pose in `frame`: its shaft as a capsule, and the shapes of its links.
void add_tool(const Tool& tool, const ToolPose& pose, const std::string& frame, MarkerSheet& sheet);

}  // namespace organ_collision
