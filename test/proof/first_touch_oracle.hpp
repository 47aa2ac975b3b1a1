#pragma once

#include <functional>
#include <optional>

#include "geometry/distance/first_touch.hpp"
#include "link_trials.hpp"

namespace organ_collision::oracle {

/// The first times of a leg at which a face is surely and may be within a radius of the core.
struct FirstTime {
  std::optional<double> certainly;  ///< the distance is at most the radius - slack here
  std::optional<double> possibly;   ///< before this, it is more than the radius + slack
};

/// By halving: nothing moves faster than its fastest corner, so that the distance amid an interval
/// bounds those in it. `slack` [m] is where it stops.
FirstTime first_time_within(const ShaftMotion& shaft, const FaceMotion& face, double radius,
                            double slack);

/// The same of a trial's core and a face, with the library's distances, which have their own test,
/// between poses by quaternions.
FirstTime first_time_within(const LinkTrial& trial, const FaceMotion& face, double slack);

/// T_organ_link of a trial at a time of the leg, by quaternions.
Eigen::Isometry3d pose_at(const LinkTrial& trial, double time);

}  // namespace organ_collision::oracle
