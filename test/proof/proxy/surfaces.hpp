#pragma once

#include "test/grid_surface.hpp"
#include "test/proof/trials.hpp"

/// Surfaces for the scenes of the haptic proxy [m]. They are around the origin.
namespace organ_collision::oracle {

/// A closed bumpy organ, about 0.18 m long and 0.06 m high, of 150 to 4500 faces. It points
/// outward.
GridSurface bumpy_organ(Random& random);

/// A thin sheet, folded into horizontal layers that are `gap` [m] apart, the upper one at z = 0.
/// The layers are joined by half circles. Each is `width` [m] wide.
GridSurface folded_sheet(int layers, double gap, double width);

/// A bent tube along z, 0.24 m long and open at both ends. It points outward.
GridSurface bent_tube(double radius, Random& random);

}  // namespace organ_collision::oracle
