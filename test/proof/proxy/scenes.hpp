#pragma once

#include <string>
#include <vector>

#include "scripted_motion.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision::oracle {

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

/// ProxyOrgan::clearances from 0.03 to 3 mm. Now and then, an organ does not hold a link.
std::vector<double> random_clearances(const ProxyTool& tool, Random& random);

}  // namespace organ_collision::oracle
