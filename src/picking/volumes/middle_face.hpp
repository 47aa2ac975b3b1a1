#pragma once

#include "organ_collision/geometry/triangle.hpp"
#include "viewing_volume.hpp"

namespace organ_collision {

/// A face across the middle of the volume's frustum, in its shifted coordinates [m]. It meets the
/// volume, because no user plane of a tool's volume cuts off that middle. Exceptions are the
/// paper's naive volume, and slivers that are so thin for their length that 32-bit clipping loses
/// the face. See doc/geometry.md, GL's clipping.
Triangle middle_face(const ViewingVolume& volume);

}  // namespace organ_collision
