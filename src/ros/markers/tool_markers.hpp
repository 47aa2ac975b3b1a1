#pragma once

#include <string>
#include <vector>

#include "marker_shapes.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "ros/tools/tool.hpp"
#include "scene.hpp"

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

/// Steps within this time leave a trail. [s]
inline constexpr double kFadeSec = 0.5;
/// The trail of a tool has at most this many legs. The oldest ones are left out.
inline constexpr std::size_t kMostLegs = 2000;

/// How visible something is, `now`, that was new at `time`: from 1 down to 0.
double visibility(SteadyTime time, SteadyTime now);

/// Adds the surface that the tool swept in these steps, the oldest of which come first: that of the
/// shaft's axis, and of the longest axis of each part of the links. It fades with the age of the
/// steps.
void add_swept(const Tool& tool, const std::vector<const SceneStep*>& steps,
               const std::string& frame, SteadyTime now, MarkerSheet& sheet);

/// The name of a state, as in msg/ProxyState.msg.
std::string name_of(ProxyStatus state);

/// "probe: TOUCHING, 1.2 N"; "probe: NO_ANSWER: ..." with the reason if there is no answer.
std::string state_line(const ProxyView& view);

/// Adds the proxy as a solid tool. If tissue holds it back, adds the hand as a translucent tool,
/// the spring between the two as a line, and an arrow for each force on the tissue. Adds the state
/// as a text above the tool's far end, and nothing else if there is no answer but the hand.
void add_proxy(const ProxyView& view, MarkerSheet& sheet);

}  // namespace organ_collision
