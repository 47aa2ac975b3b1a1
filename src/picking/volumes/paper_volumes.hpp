#pragma once

#include "organ_collision/geometry/tool/shaft.hpp"
#include "viewing_volume.hpp"

namespace organ_collision {

/// The volumes of Lombardo, Cani and Neyret, "Real-time collision detection for virtual surgery"
/// (1999), as published. They miss some faces near the sides and the end of a swept tool, and they
/// are not grown for 32-bit clipping. Radii are in metres.
///
/// The three functions throw std::invalid_argument, naming the value and what is legal, for a shaft
/// whose volume would be lost in the rounding of 32-bit clipping. Such a shaft is shorter than 1e-9
/// m, or its radius is below 1e-9 m or below a millionth of its length.

/// The static volume (section 3): a box of half-width `radius` around the axis, flat at both ends.
ViewingVolume paper_static_volume(const ShaftAxis& axis, double radius);

/// The swept volume (section 4, figures 7 and 8): a perspective camera and two user planes. The
/// trocar rests at `motion.start.trocar`. If the tip rests, or if trocar and both tips lie on a
/// line, the tool gets the static volume to the farther tip.
ViewingVolume paper_swept_volume(const ShaftMotion& motion, double radius);

/// The naive swept volume (figure 5): the orthographic box around the sweep of figure 4, and two
/// user planes along its sides. It contains the same points as paper_swept_volume.
ViewingVolume paper_naive_volume(const ShaftMotion& motion, double radius);

}  // namespace organ_collision
