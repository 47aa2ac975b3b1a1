#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "clearance_trials.hpp"
#include "geometry/distance/first_touch.hpp"
#include "link_trials.hpp"

namespace organ_collision::oracle {

/// A convex part of a tool where it is: all points within `radius` [m] of the core.
struct PlacedCore {
  ConvexCore core;
  double radius;
};

/// The parts of a tool in this pose; a mesh has one for each of its triangles. As for the
/// clearance, only shafts and balls have a radius. `shaft_radius`: 0 for a tool without a shaft.
std::vector<PlacedCore> placed_cores(double shaft_radius, const std::vector<Link>& links,
                                     const ToolPose& pose);

/// Whether a face is within `distance` [m] of the tool's surface at `fraction` of the step: its
/// distance from a core is at most `distance` plus the radius of this shaft or sphere. The surfaces
/// of all other parts are the cores themselves. Decided by exact arithmetic on the rounded poses;
/// for cylinders to about 1e-11 m.
bool is_within(const ToolStep& step, std::size_t face, double fraction, double distance);
/// Whether any face is.
bool is_within(const ToolStep& step, double fraction, double distance);

/// The radius [m] of the tool's only part around its core, if it is a shaft or a sphere; else 0.
double surface_radius(const ToolStep& step);

/// Whether a point is within `distance` [m] of a core at the end of the step.
bool is_near_core(const ToolStep& step, const Eigen::Vector3d& point, double distance);

/// The smallest distance between the tool's surface and a face [m], in doubles.
double rounded_distance(const ToolStep& step, double fraction);

/// Whether the distance is at least `bound` [m] during the whole step. A search halves the step:
/// nothing moves faster than the fastest point, so the distance in the middle of an interval bounds
/// the distances in the whole interval. `closest`: receives the smallest distance that it saw.
/// Undecided if the distance comes within 1e-9 m of the bound; the answer is then false.
bool stays_above(const ToolStep& step, double bound, double& closest);

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

/// The same for the core of a trial, whose poses are interpolated by quaternions.
FirstTime first_time_within(const LinkTrial& trial, const FaceMotion& face, double slack);

/// Whether a segment comes within `distance` [m] of a face while the ends of both move linearly.
bool passes(const ShaftMotion& segment, const FaceMotion& face, double distance);

/// T_organ_link of a trial at a time of the leg in [0, 1], interpolated by quaternions.
Eigen::Isometry3d pose_at(const LinkTrial& trial, double time);

}  // namespace organ_collision::oracle
