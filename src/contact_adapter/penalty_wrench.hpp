#pragma once

#include <geometry_msgs/Wrench.h>

#include <vector>

#include "kept_sides.hpp"

namespace organ_collision {

/// The force [N] of the tissue on the tool, and its torque [N m] about the origin of the organ's
/// frame, by a penalty law of `stiffness` [N/m]. Both are zero if there are no pushes.
///
/// A single push is a spring with the force -stiffness * depth * normal. If each face had a spring,
/// the force would grow with the resolution of the mesh. Therefore only pushes that count have a
/// spring. With normals n and depths d, the lengths l of the springs are chosen so that they cover
/// each depth and none is longer than needed:
///   sum_j l_j max(0, n_j . n_i) >= d_i and l_i >= 0 for all i, one of the two with equality,
///   force = -stiffness * sum_i l_i n_i.
/// Two walls at right angles, opposite walls, and closing jaws have a spring each. Links side by
/// side on flat tissue share one spring. In a crease the force is -stiffness times the smallest
/// displacement of the tool out of both sides. Up to a millionth of the greatest depth may stay
/// uncovered.
///
/// A spring acts at the mean place of all pushes, weighted by d_j max(0, n_j . n_i). For a shaft
/// that lies on the tissue, this is the middle of the touching part. Takes O(n) time for n pushes.
/// Throws Rejection if the result is not finite.
geometry_msgs::Wrench penalty_wrench(const std::vector<Push>& pushes, double stiffness);

}  // namespace organ_collision
