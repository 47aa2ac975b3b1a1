#pragma once

#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

/// [rad] No leg turns a link by more. An arc of a fifth leaves its chord by half a percent of its
/// radius.
inline constexpr double kMaxRotation = 0.2;

/// The same way with waypoints added where a link turns far within a leg: the boxes around an arc
/// are larger the farther it turns. `finer` holds it, unless it is the path itself.
const ToolPath& with_subdivided_rotations(const ToolPath& path, ToolPath& finer);

}  // namespace organ_collision
