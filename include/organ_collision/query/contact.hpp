#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace organ_collision {

/// The number of a tool's shaft where links are numbered. The links themselves count from 0, in the
/// order of CollisionRequest::links.
inline constexpr std::int32_t kShaft = -1;

/// One face that a tool touches, with the fields of msg/Contact.msg. (The message's C++ type is
/// already called organ_collision::Contact.)
///
/// Lengths are in metres, points and vectors in the organ's frame. "The tool" is the shaft's axis
/// with its radius, or the touching part of a link. A contact describes the first touch within the
/// step, except where a field says that it describes the end of the step. In a static query both
/// times are the same.
///
/// If the tool does not touch the face when the step begins, the distance between `point` and the
/// axis is the radius, to within 1e-9 m. In a static query, moving the tool by -depth * normal
/// brings its distance to the face back to the radius. If the tool pierces the face, that motion
/// makes the distance at least the radius.
struct FaceContact {
  /// The number of the face: its place among the organ's triangles, from 0.
  std::uint32_t face = 0;
  /// The indices of the face's corners in the organ's vertices, in the order of `barycentric`.
  std::array<std::uint32_t, 3> vertices = {};
  /// The number of the link that touches, from 0, or kShaft.
  std::int32_t link = kShaft;
  /// Whether the shaft or link is within reach of the face at the end of the step: whether a static
  /// query there has a contact of both. True, for safety, if the query reached its work limit
  /// before it could decide.
  bool touching = false;
  /// The time of the first touch as a fraction of the step, in [0, 1]; 0 in a static query.
  double fraction = 0.0;
  /// The point of the face that is nearest to the axis or link at the first touch. If several
  /// points are equally near to an axis, it is the point nearest to the tip.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// The unit vector from the axis or link to `point`. If the axis or link pierces the face (their
  /// distance is at most tolerance::kPierced), `normal` is the face's own normal or its opposite: a
  /// motion of the tool along -normal parts it from the face. For a shaft, the sign is such that
  /// normal · (tip - trocar) >= 0. For a link, it is the sign for which that motion is shorter.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// Barycentric coordinates of `point` in the face, in the order of `vertices`.
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  /// The place on the axis that is nearest to `point`, in [0, 1] from trocar to tip; 0 for links.
  double shaft = 0.0;
  /// The penetration along `normal` at the end of the step. Negative: the tool touched the face and
  /// left it again. If the tool pierces the face, `depth` is the penetration of the tip, or of the
  /// point of the link that is farthest along `normal`.
  double depth = 0.0;
  /// Whether the point of the axis or link that touched the face first is on the inner side of the
  /// face at the end of the step. The right-hand rule gives the outer side.
  bool behind = false;
  /// The point of the face with the coordinates `barycentric`, where it is at the end of the step.
  Eigen::Vector3d on_organ = Eigen::Vector3d::Zero();
  /// [m/s] The velocity of the tissue there (CollisionRequest::velocity_from).
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  /// False if the query reached its work limit before it could decide on this face. The face is
  /// then reported for safety: it may not be touched at all, and point, normal and depth may differ
  /// from those of the first touch. The message has no such field: ContactArray.msg counts these
  /// contacts.
  bool is_resolved = true;

  /// The tool's surface there, at the end of the step: on_tool() - on_organ = depth * normal.
  Eigen::Vector3d on_tool() const { return on_organ + depth * normal; }
};

}  // namespace organ_collision
