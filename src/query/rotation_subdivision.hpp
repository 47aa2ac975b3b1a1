#pragma once

#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

/// [rad] The largest rotation of a link within one leg. An arc of 0.2 rad deviates from its chord
/// by half a percent of its radius.
inline constexpr double kMaxRotation = 0.2;

/// The same motion with waypoints added, so that no link rotates by more than kMaxRotation within a
/// leg. Larger rotations would make the boxes around the moving link loose. Returns `path` itself
/// if no waypoint is needed. Otherwise fills and returns `finer`.
const ToolPath& with_subdivided_rotations(const ToolPath& path, ToolPath& finer);

}  // namespace organ_collision
