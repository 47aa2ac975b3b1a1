#pragma once

#include <cstddef>

#include "tool_step.hpp"

namespace organ_collision::oracle {

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

}  // namespace organ_collision::oracle
