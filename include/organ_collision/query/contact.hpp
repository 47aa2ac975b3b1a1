#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace organ_collision {

/// One face that a tool touches, with the fields of msg/Contact.msg. (The message's C++ type is
/// already called organ_collision::Contact.)
///
/// Lengths are in metres, points and vectors in the organ's frame. "The tool" is the shaft's axis
/// with its radius, or the touching part of a link. A contact describes the first touch within the
/// step, except where a field says that it describes the end of the step. In a static query both
/// are the same.
///
/// If the tool does not touch the face when the step begins, the distance between `point` and the
/// axis is the radius, to within 1e-9 m. In a static query, moving the tool by -depth * normal
/// brings its distance to the face back to the radius. If the tool pierces the face, the distance
/// is then at least the radius.
struct FaceContact {
  /// The number of the face: its place among the organ's triangles, from 0.
  std::uint32_t face = 0;
  /// The indices of the face's corners in the organ's vertices, in the order of `barycentric`.
  std::array<std::uint32_t, 3> vertices = {};
  /// Which link of the tool touches. If the tool has a shaft, the shaft is 0 and its links follow
  /// from 1; else its links count from 0.
  std::uint32_t link = 0;
  /// Time of the first touch as a fraction of the step, in [0, 1]; 0 in a static query.
  double fraction = 0.0;
  /// The point of the face nearest the axis or link at the first touch. Of several nearest points,
  /// the one nearest the tip.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// Unit vector from the axis or link to `point`. If the axis or link pierces the face (their
  /// distance is at most tolerance::kPierced), it is the face's own normal or its opposite, with
  /// the sign for which a motion along -normal parts the tool from the face. For a shaft, normal ·
  /// (tip - trocar) >= 0. For a link, it is the sign for which that motion is shorter.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// Barycentric coordinates of `point` in the face, in the order of `vertices`.
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  /// The place on the axis nearest `point`, in [0, 1] from trocar to tip; 0 for links.
  double shaft = 0.0;
  /// Penetration along `normal` at the end of the step. Negative: the tool touched the face and
  /// left it again. If the tool pierces the face, it is the penetration of the tip, or of the
  /// link's foremost point along `normal`.
  double depth = 0.0;
  /// Whether the place on the axis or link that touched is on the inner side of the face at the end
  /// of the step. The outer side follows from the right-hand rule.
  bool behind = false;
  /// Where the point of the face with the same barycentric coordinates is at the end of the step.
  Eigen::Vector3d end_point = Eigen::Vector3d::Zero();
  /// False if the query reached its work limit before it could decide on this face. The face is
  /// then reported to be safe: it may not touch at all, and point, normal and depth may differ from
  /// those of the first touch. The message has no such field; it counts these contacts.
  bool is_resolved = true;
  /// The smallest depth [m], along the view, of the part of the face inside the volume, measured
  /// from the plane of the trocar. Set only in the paper modes, which set no other field except
  /// `face` and `view_max`.
  double view_min = 0.0;
  /// The largest such depth [m].
  double view_max = 0.0;
};

}  // namespace organ_collision
