#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scripted_motion.hpp"
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

/// A tool, a hand and organs.
struct ProxyScene {
  ProxySettings settings;
  HandScript hand;
  std::vector<ScriptedOrgan> organs;
};

/// The names of the kinds of scenes.
const std::vector<std::string>& proxy_scene_kinds();

/// A random scene of this kind. The hand starts outside, away from all tissue. Throws
/// std::out_of_range for an unknown kind.
ProxyScene make_proxy_scene(const std::string& kind, Random& random);

}  // namespace organ_collision::oracle
