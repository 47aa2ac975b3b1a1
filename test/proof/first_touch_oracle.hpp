#pragma once

#include <optional>

#include "organ_collision/geometry/first_touch.hpp"

namespace organ_collision::oracle {

/// The first times of a leg at which a face is surely and may be within a radius of the axis.
struct FirstTime {
  std::optional<double> certainly;  ///< the distance is at most the radius - slack here
  std::optional<double> possibly;   ///< before this, it is more than the radius + slack
};

/// By halving: nothing moves faster than its fastest corner, so that the distance amid an interval
/// bounds those in it. `slack` [m] is where it stops.
FirstTime first_time_within(const ShaftMotion& shaft, const FaceMotion& face, double radius,
                            double slack);

}  // namespace organ_collision::oracle
