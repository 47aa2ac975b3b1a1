#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <string>
#include <vector>

#include "marker_shapes.hpp"
#include "scene.hpp"

namespace organ_collision {

/// A mesh of a link with more faces is drawn as its bounding box, because the tools are sent with
/// each picture.
inline constexpr std::size_t kMostFacesOfTool = 5000;
/// The trail of a tool has at most this many legs. The oldest ones are left out.
inline constexpr std::size_t kMostLegs = 2000;

/// Adds the tool at a pose in the frame of the style: its shaft as a capsule, and the shapes of its
/// links.
void add_tool(const Tool& tool, const ToolPose& pose, const MarkerStyle& style,
              visualization_msgs::MarkerArray& picture);

/// Adds the surface that the tool swept in these steps, the oldest of which come first: that of the
/// shaft's axis, and of the longest axis of each part of the links. It fades with the age of the
/// steps.
void add_swept(const Tool& tool, const std::vector<const SceneStep*>& steps,
               const std::string& frame, SteadyTime now, visualization_msgs::MarkerArray& picture);

/// The name of a state, as in msg/ProxyState.msg.
std::string name_of(ProxyStatus state);

/// Adds the proxy as a solid tool. If tissue holds it back, adds the hand as a translucent tool,
/// the spring between the two as a line, and an arrow for each force on the tissue. Adds the state
/// as a text above the tool's far end, and nothing else if there is no answer but the hand.
void add_proxy(const ProxyView& view, visualization_msgs::MarkerArray& picture);

}  // namespace organ_collision
