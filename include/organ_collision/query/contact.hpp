#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace organ_collision {

/// One face that a tool touches, as msg/Contact.msg has it (whose C++ name is
/// organ_collision::Contact, hence this one). Lengths in metres, vectors in the
/// organ's frame.
struct FaceContact {
  std::uint32_t face = 0;
  /// Its corners: indices of the organ's vertices, in the order of `barycentric`.
  std::array<std::uint32_t, 3> vertices = {};
  /// Of the tool: its shaft, if it has one, is 0, and its links follow.
  std::uint32_t link = 0;
  /// First touch, as a share of the step, in [0, 1]; 0 when static.
  double fraction = 0.0;
  /// The face's point nearest the axis, or the link, at first touch.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// Unit, from the axis, or the link, to `point`; the face's own where they pierce it, turned the
  /// tip's way, or so that the link's way back out is the shorter one.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// Of `point` in the face, in the order of its vertices.
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  /// Place on the axis nearest `point`, in [0, 1] from trocar to tip; 0 for links.
  double shaft = 0.0;
  /// Penetration along `normal` at the end of the step; negative: touched and left. Where a tool
  /// pierces the face, that of its tip, or of the link's foremost point.
  double depth = 0.0;
  /// That place on the axis, or the link, is on the face's inner side at the end of the step.
  bool behind = false;
  /// The same point of the face, by its barycentrics, at the end of the step.
  Eigen::Vector3d end_point = Eigen::Vector3d::Zero();
  /// False: reported to be safe, since the work that a query may cost was used up. Its point,
  /// normal and depth need not be those of the first touch then. Not in the message.
  bool is_resolved = true;
  /// Paper modes only, which set nothing else but the face: depth range along the view, from the
  /// plane of the trocar.
  double view_min = 0.0;
  double view_max = 0.0;
};

}  // namespace organ_collision
