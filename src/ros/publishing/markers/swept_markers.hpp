#pragma once

#include <string>
#include <vector>

#include "marker_sheet.hpp"
#include "scene.hpp"

namespace organ_collision {

/// Steps within this time leave a trail. [s]
inline constexpr double kFadeSec = 0.5;
/// The trail of a tool has at most this many legs. The oldest ones are left out.
inline constexpr std::size_t kMostLegs = 2000;

/// How visible something is, `now`, that was new at `time`: from 1 down to 0.
double visibility(SteadyTime time, SteadyTime now);

/// Adds the surface that the tool swept in these steps, the oldest of which come first: that of the
/// shaft's axis, and of the longest axis of each part of the links. It fades with the age of the
/// steps.
void add_swept(const Tool& tool, const std::vector<const SceneStep*>& steps,
               const std::string& frame, SteadyTime now, MarkerSheet& sheet);

}  // namespace organ_collision
