#pragma once

#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision {

// All throw std::invalid_argument, naming the value and what is legal.

void check_tool(const ProxyTool& tool);
void check_settings(const ProxyTool& tool, const ProxySettings& settings);
void check_hand(const ProxyTool& tool, const ToolPose& hand);
void check_organs(const std::vector<ProxyOrgan>& organs);

}  // namespace organ_collision
