#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// How a point of the tissue pushes the tool. Lengths in metres, vectors in the organ's frame.
struct Push {
  Eigen::Vector3d place;   ///< of the point, at the end of the step
  Eigen::Vector3d normal;  ///< unit, into the tissue; the tool is pushed against it
  double depth;            ///< along the normal; negative if the tool has left the face
  /// Whether it has a spring: it is nearest the tool in its surroundings, or it belongs to another
  /// side of a crease.
  bool counts;
};

}  // namespace organ_collision
