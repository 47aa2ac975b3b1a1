#pragma once

#include <string>

#include "colours.hpp"
#include "marker_sheet.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// A mesh of a link with more faces is drawn as its bounding box, because the tools are sent with
/// each picture.
inline constexpr std::size_t kMostFacesOfTool = 5000;

/// How a tool is drawn.
struct ToolLook {
  std::string name_space = marker_names::kTools;
  std_msgs::ColorRGBA colour = colours::tool();
};

/// Adds the tool at a pose in `frame`: its shaft as a capsule, and the shapes of its links.
void add_tool(const Tool& tool, const ToolPose& pose, const std::string& frame, MarkerSheet& sheet,
              const ToolLook& look = {});

}  // namespace organ_collision
