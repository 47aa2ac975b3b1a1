#include "scripted_tools.hpp"

#include <algorithm>
#include <cmath>

#include "liver.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// A sine with a period of `period` seconds.
double wave(double seconds, double period) { return std::sin(2.0 * M_PI * seconds / period); }

/// [m] The z coordinate of the front of the resting liver at (x, y), by bisection.
double front_of_liver(double x, double y) {
  double inside = 0.0, outside = 0.1;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (inside + outside);
    (liver_level({x, y, middle}) < 0.0 ? inside : outside) = middle;
  }
  return inside;
}

Vector3d palpator_tip(double seconds) {
  constexpr double kLift = 0.003, kPress = 0.022;  // [m] from first touch upwards and downwards
  const double x = -0.045 + 0.022 * wave(seconds, 11.0);
  const double y = -0.004 + 0.020 * wave(seconds, 7.0);
  const double press = 0.5 - 0.5 * wave(seconds + 0.75, 3.0);
  return {x, y, front_of_liver(x, y) + kToolRadius + kLift - press * (kLift + kPress)};
}

/// 0 in front of the lobe, 1 behind it. The tool passes from one to the other at each full second.
double stab_progress(double seconds) {
  const double second = std::floor(seconds);
  const double share = std::min((seconds - second) / kStabDuration, 1.0);
  const bool forth = std::fmod(second, 2.0) == 1.0;
  if (second < 1.0) return 0.0;
  return forth ? share : 1.0 - share;
}

Vector3d stabber_tip(double seconds) {
  const Vector3d in_front{0.068, 0.030, 0.052}, behind{0.068, 0.030, -0.056};
  const Vector3d sway{0.010 * wave(seconds, 6.5), 0.0, 0.0};
  return in_front + stab_progress(seconds) * (behind - in_front) + sway;
}

}  // namespace

const std::vector<ScriptedTool>& scripted_tools() {
  static const std::vector<ScriptedTool> tools{
      {"palpator", {-0.075, -0.100, 0.150}, palpator_tip, true},
      {"stabber", {0.095, -0.130, 0.040}, stabber_tip, false},
  };
  return tools;
}

}  // namespace organ_collision
