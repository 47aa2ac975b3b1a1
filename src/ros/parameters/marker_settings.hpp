#pragma once

#include "ros/interface/parameter_group.hpp"

namespace organ_collision {

/// How markers are published and drawn.
struct MarkerSettings {
  double markers_rate_hz = 30.0;  ///< 0: no markers
  double surface_rate_hz = 30.0;  ///< of the surface of each organ; 0: no surfaces
  double markers_depth = 0.01;    ///< [m] deeper contacts all have the last colour of the map
};

/// [Hz] Legal values of the rates, besides those that parse_rate() refuses.
inline constexpr NumberRange kFrameRates{0.0, 1000.0};

/// A rate, which may be zero, but not so small that its period is longer than ROS timers accept.
/// Throws ParameterError.
double parse_rate(const ParameterGroup& all, const char* name, double fallback,
                  const NumberRange& range);

/// The parameters markers_rate and surface_rate. Missing ones keep their values. Throws
/// ParameterError.
void parse_marker_rates(const ParameterGroup& all, MarkerSettings& markers);

}  // namespace organ_collision
