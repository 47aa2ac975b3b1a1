#pragma once

#include <string>

namespace organ_collision {

/// Asks a node to end, as `rosnode kill` does. Returns false if there is no such node, or if it
/// does not answer.
bool end_node(const std::string& name);

}  // namespace organ_collision
