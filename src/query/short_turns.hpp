#pragma once

#include "organ_collision/geometry/tool_path.hpp"

namespace organ_collision {

/// The same way with waypoints added where a link turns far within a leg: the boxes around an arc
/// are larger the farther it turns. `finer` holds it, unless it is the path itself.
const ToolPath& with_short_turns(const ToolPath& path, ToolPath& finer);

}  // namespace organ_collision
