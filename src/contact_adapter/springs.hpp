#pragma once

#include <Eigen/Core>
#include <vector>

namespace organ_collision {

/// How a point of the tissue pushes the tool. Lengths in metres, vectors in the organ's frame.
struct Push {
  Eigen::Vector3d place;   ///< the point, at the end of the step
  Eigen::Vector3d normal;  ///< unit, into the tissue; the tool is pushed against it
  double depth;            ///< along the normal; negative if the tool has left the face
  /// Whether the push has a spring of its own; see penalty_forces(). It has one if no face around
  /// its face extends nearer to the tool; see basins_of(). It also has one if a shaft's axis has
  /// passed a crease, and its face is on another side of the crease than the face nearest to the
  /// tool.
  bool counts;
};

/// The forces [N] of the tissue on the tool by a penalty law of `stiffness` [N/m]: one for each
/// push, which acts at its place. All are zero if no push has a depth.
///
/// A single push is a spring with the force -stiffness * depth * normal. If each face had a spring,
/// the force would grow with the resolution of the mesh. Therefore only pushes that count have a
/// spring. With normals n and depths d, the lengths l of the springs are chosen so that they cover
/// each depth and none is longer than needed:
///   sum_j l_j max(0, n_j . n_i) >= d_i and l_i >= 0 for all i, one of the two with equality,
///   sum of the forces = -stiffness * sum_i l_i n_i.
/// Two walls at right angles, opposite walls, and closing jaws have a spring each. Links side by
/// side on flat tissue share one spring. In a crease the force is -stiffness times the smallest
/// displacement of the tool out of both sides. Up to a millionth of the greatest depth may stay
/// uncovered.
///
/// The force of spring i is shared among all pushes j, in proportion to d_j max(0, n_j . n_i). For
/// a shaft that lies on the tissue, the sum therefore acts at the middle of the touching part.
/// Takes O(n) time for n pushes. Throws Rejection if a force or the sum of the torques is not
/// finite.
std::vector<Eigen::Vector3d> penalty_forces(const std::vector<Push>& pushes, double stiffness);

}  // namespace organ_collision
