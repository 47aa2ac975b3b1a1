#pragma once

#include <string>

#include "marker_sheet.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// What one picture shows of a hand and its proxy.
struct ProxyView {
  Tool tool;
  std::string frame;             ///< the proxy's frame
  std::optional<ToolPose> hand;  ///< in this frame; not set: it is not known
  ProxyAnswer answer;            ///< to this hand
  double force = 0.0;            ///< [N] the magnitude of the force on the hand
  double size = 0.1;             ///< [m] of the scene: widths and heights of texts are shares of it
};

/// The name of a state, as in msg/ProxyState.msg.
std::string name_of(ProxyState state);

/// "probe: TOUCHING, 1.2 N"; "probe: NO_ANSWER: ..." with the reason if there is no answer.
std::string state_line(const ProxyView& view);

/// Adds the proxy as a solid tool. If tissue holds it back, adds the hand as a translucent tool,
/// the spring between the two as a line, and an arrow for each force on the tissue. Adds the state
/// as a text above the tool's far end, and nothing else if there is no answer but the hand.
void add_proxy(const ProxyView& view, MarkerSheet& sheet);

}  // namespace organ_collision
