#include "separating_plane.hpp"

namespace organ_collision {

bool stays_beyond(const Eigen::Vector3d& normal, const CoreMotion& core, const FaceMotion& face,
                  double distance) {
  const double reach = distance + core.chord_deviation(1.0, normal);
  return project_onto(normal, face.start).low - core.start().support_value(normal) > reach &&
         project_onto(normal, face.end).low - core.end().support_value(normal) > reach;
}

}  // namespace organ_collision
