#pragma once

#include <functional>
#include <optional>

#include "geometry/distance/first_touch.hpp"
#include "link_trials.hpp"

namespace organ_collision::oracle {

/// Bounds on the first time of a leg, in [0, 1], at which a face is within a radius of the core.
struct FirstTime {
  std::optional<double> certainly;  ///< at this time, the distance is at most radius - slack
  std::optional<double> possibly;   ///< before this time, it is more than radius + slack
};

/// Searches by bisection. Nothing moves faster than the fastest corner, so the distance in the
/// middle of an interval bounds the distances in the whole interval. `slack`: where the bisection
/// stops [m].
FirstTime first_time_within(const ShaftMotion& shaft, const FaceMotion& face, double radius,
                            double slack);

/// The same for the core of a trial. It uses the library's distances, which have their own test,
/// and interpolates poses by quaternions.
FirstTime first_time_within(const LinkTrial& trial, const FaceMotion& face, double slack);

/// T_organ_link of a trial at a time of the leg in [0, 1], interpolated by quaternions.
Eigen::Isometry3d pose_at(const LinkTrial& trial, double time);

}  // namespace organ_collision::oracle
