#pragma once

#include <Eigen/Core>
#include <vector>

namespace organ_collision {

/// The polygon in which a face meets a viewing volume: its corners in the organ's frame [m], in
/// their order along its border. Empty if the face does not meet the volume.
using Region = std::vector<Eigen::Vector3d>;

}  // namespace organ_collision
