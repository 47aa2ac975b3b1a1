#pragma once

#include <string>

#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// A laparoscopic instrument with a scripted motion through a fixed trocar, in the liver's frame.
struct ScriptedTool {
  std::string name;
  Eigen::Vector3d trocar;                  ///< [m]
  Eigen::Vector3d (*tip)(double seconds);  ///< [m] at a time since the start

  ShaftAxis at(double seconds) const { return {trocar, tip(seconds)}; }
};

/// [m] Radius of both tools.
inline constexpr double kToolRadius = 0.005;

/// [s] The stabber passes through the left lobe at each full second, within this time.
inline constexpr double kStabDuration = 0.005;

/// Held by a hand that moves slowly over the front of the right lobe, and presses into it and lifts
/// in turn.
extern const ScriptedTool kPalpator;
/// Stabs through the left lobe, and rests in front of it and behind it in turn.
extern const ScriptedTool kStabber;

}  // namespace organ_collision
