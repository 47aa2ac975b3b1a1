#pragma once

#include <geometry_msgs/Wrench.h>
#include <organ_collision/Contact.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace organ_collision {

/// A force of the tissue on the tool. It acts at a point of a face. In the organ's frame.
struct FaceForce {
  std::uint32_t face;                       ///< Contact.face
  std::uint32_t link;                       ///< Contact.link
  Contact::_vertices_type vertices;         ///< the face's corners
  Contact::_barycentric_type barycentric;   ///< of the point, in the order of `vertices`
  Eigen::Vector3d place;                    ///< [m] the point, at the end of the step
  Eigen::Vector3d force = {0.0, 0.0, 0.0};  ///< [N]
};

/// The sum of the forces [N], and of their torques about the origin of the organ's frame [N m].
geometry_msgs::Wrench wrench_of(const std::vector<FaceForce>& forces);

}  // namespace organ_collision
