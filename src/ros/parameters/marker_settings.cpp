#include "marker_settings.hpp"

#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

constexpr double kSlowest = 0.001;  // [Hz]

}  // namespace

double parse_rate(const ParameterGroup& all, const char* name, double fallback,
                  const NumberRange& range) {
  const double rate = all.number(name, fallback, range);
  if (rate > 0.0 && rate < kSlowest) all.refuse(name, "must be 0 or at least 0.001");
  return rate;
}

void parse_marker_rates(const ParameterGroup& all, MarkerSettings& markers) {
  markers.markers_rate_hz =
      parse_rate(all, names::kMarkersRate, markers.markers_rate_hz, kFrameRates);
  markers.surface_rate_hz =
      parse_rate(all, names::kSurfaceRate, markers.surface_rate_hz, kFrameRates);
}

}  // namespace organ_collision
