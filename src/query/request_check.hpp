#pragma once

#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// [1] The largest difference, in an element, of R times its transpose from the identity, where R
/// is the linear part of a legal pose.
inline constexpr double kRotationTolerance = 1e-9;

// All checks throw std::invalid_argument. Its text names the value and what is legal.

/// Refuses a request that has no answer (see CollisionQuery::evaluate).
void check(const CollisionRequest& request);

/// The viewing volume of a request in one of the paper's modes, which check() has accepted. Throws
/// if the shaft is too short or too thin for the volume.
ViewingVolume paper_volume(const CollisionRequest& request);

void check_tool(const ProxyTool& tool);
void check_settings(const ProxyTool& tool, const ProxySettings& settings);
void check_hand(const ProxyTool& tool, const ToolPose& hand);
void check_organs(const ProxyTool& tool, const std::vector<ProxyOrgan>& organs);

}  // namespace organ_collision
