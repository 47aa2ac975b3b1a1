#pragma once

#include "geometry/distance/swept_box.hpp"
#include "viewing_volume.hpp"
#include "volume_margin.hpp"

namespace organ_collision {

/// An orthographic box that contains a link's box, grown by its radius and by margin.motion, at
/// every time of the leg. It is grown for 32-bit clipping like the conservative volume of a shaft.
ViewingVolume conservative_volume(const SweptBox& box, const VolumeMargin& margin);

/// The same without margins. Regions of contacts are clipped to it.
ViewingVolume tool_volume(const SweptBox& box);

}  // namespace organ_collision
