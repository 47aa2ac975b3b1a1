#pragma once

#include <Eigen/Core>

namespace organ_collision {

/// How a point of the tissue pushes the tool. Lengths in metres, vectors in the organ's frame.
struct Push {
  Eigen::Vector3d place;   ///< of the point, at the end of the step
  Eigen::Vector3d normal;  ///< unit, into the tissue; the tool is pushed against it
  double depth;            ///< along the normal; negative if the tool has left the face
  bool counts;             ///< whether it has a spring: a local minimum, or a face of another side
};

}  // namespace organ_collision
