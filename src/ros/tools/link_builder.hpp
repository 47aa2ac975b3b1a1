#pragma once

#include <string>

#include "link_description.hpp"
#include "organ_collision/geometry/tool/link.hpp"

namespace organ_collision {

/// The link with its collision geometry. Throws ToolError, which names the link and the illegal
/// size, pose or mesh.
Link build_link(const std::string& name, LinkDescription description);

}  // namespace organ_collision
