#pragma once

#include "organ_collision/geometry/tool/shaft.hpp"
#include "viewing_volume.hpp"
#include "volume_margin.hpp"

namespace organ_collision {

/// A volume that contains every point within `radius` + margin.motion [m] of the axis at some time
/// of the leg. This holds for every motion: with a resting or moving trocar, with the tip at the
/// trocar, along the axis, and without motion (the static query). The volume is grown so that
/// 32-bit clipping loses no face whose vertices are within `margin.extent` of the trocar. See
/// doc/geometry.md, Conservative wedge and Margins.
ViewingVolume conservative_volume(const ShaftMotion& motion, double radius,
                                  const VolumeMargin& margin);

/// The conservative volume without its margins. Regions of contacts are clipped to it.
ViewingVolume tool_volume(const ShaftMotion& motion, double radius);

}  // namespace organ_collision
