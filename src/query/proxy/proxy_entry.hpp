#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mobility.hpp"
#include "proxy_motion.hpp"
#include "tissue.hpp"

namespace organ_collision {

/// Where a proxy comes from when it is placed anew. From there it moves to the hand like any proxy.
struct ProxyEntry {
  std::optional<ProxyPlace> place;
  std::string why_not;  ///< a sentence if there is no place
};

/// A tool through a trocar enters along its axis: it begins with its tip at the trocar. A free tool
/// begins where the hand is or, if it touches tissue there or is inside an organ, beyond all
/// organs, on the hand's side.
ProxyEntry enter(const ProxyTool& tool, const Mobility& mobility, const ToolPose& hand,
                 double clearance, const std::vector<OrganTick>& organs, Tissue& tissue);

}  // namespace organ_collision
