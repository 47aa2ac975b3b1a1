#pragma once

#include <optional>
#include <string>

#include "node/markers/markers.hpp"
#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision {

/// What RViz shows of a hand and its proxy.
struct ProxyView {
  Tool tool;
  std::string frame;             ///< the proxy's frame
  std::optional<ToolPose> hand;  ///< the hand's pose in this frame; not set: it is not known
  ProxyAnswer answer;            ///< the answer to this pose of the hand
  double force = 0.0;            ///< [N] the magnitude of the force on the hand
  double size = 0.1;  ///< [m] the scene's size: widths and heights of texts are shares of it
};

/// The name of a proxy's state, as in msg/ProxyState.msg.
std::string name_of(ProxyStatus state);
/// The colour for the state of a proxy: for its text, and for the line between hand and proxy.
std_msgs::ColorRGBA colour_of(ProxyStatus state);

/// Adds the proxy as a solid tool. If tissue holds it back, adds the hand as a translucent tool,
/// the spring between the two as a line, and an arrow for each force on the tissue. If there is no
/// answer, adds only the hand. Always adds the state as a text above the tool's far end.
void add_proxy(const ProxyView& view, visualization_msgs::MarkerArray& picture);

}  // namespace organ_collision
