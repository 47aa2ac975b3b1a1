#pragma once

#include <string>

#include "marker_sheet.hpp"
#include "scene.hpp"

namespace organ_collision {

/// The name of a state, as in msg/ProxyState.msg.
std::string name_of(ProxyStatus state);

/// "probe: TOUCHING, 1.2 N"; "probe: NO_ANSWER: ..." with the reason if there is no answer.
std::string state_line(const ProxyView& view);

/// Adds the proxy as a solid tool. If tissue holds it back, adds the hand as a translucent tool,
/// the spring between the two as a line, and an arrow for each force on the tissue. Adds the state
/// as a text above the tool's far end, and nothing else if there is no answer but the hand.
void add_proxy(const ProxyView& view, MarkerSheet& sheet);

}  // namespace organ_collision
