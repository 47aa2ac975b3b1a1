#pragma once

#include <Eigen/Core>
#include <vector>

namespace organ_collision {

/// Corners of the polygon in which a face meets a viewing volume, in the organ's frame [m]; empty
/// where it does not. Exact on the face to float precision.
using Region = std::vector<Eigen::Vector3d>;

}  // namespace organ_collision
