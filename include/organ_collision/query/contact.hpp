#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace organ_collision {

/// One face that a tool touches, as msg/Contact.msg has it. Lengths in metres, vectors in the
/// organ's frame.
struct Contact {
  std::uint32_t face;
  std::uint32_t link;           ///< of the tool; 0 for a plain shaft
  double fraction;              ///< first touch, as a share of the step, in [0, 1]; 0 when static
  Eigen::Vector3d point;        ///< the face's point nearest the axis, at first touch
  Eigen::Vector3d normal;       ///< unit, from the axis to `point`
  Eigen::Vector3d barycentric;  ///< of `point` in the face, in the order of its vertices
  double shaft;                 ///< place on the axis nearest `point`, in [0, 1] from trocar to tip
  double depth;     ///< penetration along `normal` at the end of the step; negative: touched and left
  bool behind;      ///< that place on the axis is on the face's inner side at the end of the step
  double view_min;  ///< paper modes only: depth range along the view, behind the near plane
  double view_max;
};

}  // namespace organ_collision
