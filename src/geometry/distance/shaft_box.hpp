#pragma once

#include "organ_collision/geometry/tool/oriented_box.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// A box around all positions of an axis during a leg. Its first edge is along the axis, the second
/// one along the motion of the tip. An axis at rest has a box without width.
OrientedBox box_around(const ShaftMotion& motion);

}  // namespace organ_collision
