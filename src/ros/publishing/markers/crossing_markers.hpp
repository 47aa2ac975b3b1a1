#pragma once

#include <organ_collision/ToolPlacement.h>

#include <cstddef>

#include "marker_sheet.hpp"
#include "scene.hpp"

namespace organ_collision {

/// At most this many crossings of a tool and an organ are drawn: the first ones from the trocar.
inline constexpr std::size_t kMostCrossings = 100;

/// Adds an arrow head around the shaft for each place where its axis pierces the organ. The heads
/// point along the axis and stand outside the organ: where the axis enters, the head ends at the
/// surface, and where it leaves, it begins there. `radius`: of the shaft [m].
void add_crossings(const SceneOrgan& organ, const ShaftAxis& axis, double radius,
                   const ToolPlacement& placement, MarkerSheet& sheet);

}  // namespace organ_collision
