#pragma once

#include <Eigen/Core>

#include "picture.hpp"

namespace organ_collision {

/// The colour of a lit surface, by the reflection models of Lambert and Blinn. The light comes from
/// above the viewer's left shoulder. `normal`: unit, in camera coordinates, on the side that the
/// viewer sees. The opacity is that of `colour`.
Colour lit(const Colour& colour, const Eigen::Vector3d& normal);

}  // namespace organ_collision
