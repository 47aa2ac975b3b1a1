#pragma once

#include <geometry_msgs/Wrench.h>

#include <vector>

#include "kept_sides.hpp"

namespace organ_collision {

/// The force [N] of the tissue on the tool, and its torque [N m] about the origin of the organ's
/// frame: a penalty law of `stiffness` [N/m]. It is zero without pushes.
///
/// One push is a spring: its force is -stiffness * depth * normal. Springs for all faces would add
/// up to more the finer the mesh is. So only the pushes that count have a spring, and with normals
/// n and depths d their lengths l are such that each depth is made up for, and no length is longer
/// than needed:
///   sum_j l_j max(0, n_j . n_i) >= d_i and l_i >= 0 for all i, one of the two with equality,
///   force = -stiffness * sum_i l_i n_i.
/// So two walls at right angles, opposite walls, and jaws that close are springs of their own.
/// Links side by side on flat tissue are one spring. In a crease the force is that of the smallest
/// shift of the tool that leaves both sides. Depths are made up for to a millionth of the greatest.
///
/// A spring acts at the mean place of all pushes, weighted by d_j max(0, n_j . n_i): in the middle
/// of a shaft that lies on the tissue. Of n pushes it takes O(n) time.
/// Throws Rejection if the result is not finite.
geometry_msgs::Wrench penalty_wrench(const std::vector<Push>& pushes, double stiffness);

}  // namespace organ_collision
