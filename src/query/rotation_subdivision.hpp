#pragma once

#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

/// [rad] The largest rotation of a link within one leg. An arc of 0.2 rad deviates from its chord
/// by half a percent of its radius.
inline constexpr double kMaxRotation = 0.2;

/// The same motion with waypoints added, so that no link rotates by more than kMaxRotation within a
/// leg: the larger the rotation, the looser are the boxes around the moving link. Returns `path`
/// itself if nothing is to be added, else `finer`, which it fills.
const ToolPath& with_subdivided_rotations(const ToolPath& path, ToolPath& finer);

}  // namespace organ_collision
