#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <organ_collision/ContactArray.h>

namespace organ_collision {

/// The force [N] of the tissue on the tool, and its torque [N m] about the origin of the organ's
/// frame, under the header of the contacts: a penalty law of `stiffness` [N/m]. Zero without
/// contacts; what the tool touched and left (depth <= 0) does not push.
///
/// One contact is a spring: the force is -stiffness * depth * normal, against Contact.normal, which
/// points from the tool into the tissue. Springs for all faces would add up to more the finer the
/// mesh is, and nearest points of faces beside the deepest one have slanted normals even where the
/// tissue is flat: their mean would be too weak, down to nothing. Hence, with p points, n normals
/// and d depths:
/// - Once a link (or the shaft) has left the plane across n_k through p_k, it has left all that
/// lies
///   behind it. What counts of contact i is u_i = min(d_i, n_k . (p_k - p_i) of each deeper contact
///   k of the same link), or 0 if that is negative: of flat tissue, or bulging, only the deepest
///   contact, however it is divided. Not so of other links: jaws close around what they hold.
/// - Where several count, of whatever links, their sum is scaled such that along no n_k they push
///   more than the deepest one does:
///   F = -stiffness * max(d) * sum(u_i n_i) / max_k sum(u_i max(0, n_i . n_k)).
///   Opposite walls, walls at right angles, and jaws are springs of their own then; links side by
///   side, or one over the other, on flat tissue are one; in a crease, the force is that of the
///   smallest shift of the tool that leaves both sides; in a dent of the tool's own shape, as one
///   contact's.
/// - The force of contact i acts at the mean of the points, weighted by d_j max(0, n_j . n_i):
///   in the middle of a shaft that lies on the tissue, and opposite pushes at two places turn the
///   tool.
/// The law is local: where a whole shaft or link has sunk below the surface, normals and force may
/// point on inward.
///
/// The contacts are as check_contacts() wants them. Throws Rejection if the result is not finite.
geometry_msgs::WrenchStamped penalty_wrench(const ContactArray& contacts, double stiffness);

}  // namespace organ_collision
