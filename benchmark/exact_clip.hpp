#pragma once

#include <vector>

#include "organ_collision/geometry/half_space.hpp"
#include "organ_collision/geometry/triangle_mesh.hpp"

namespace organ_collision::bench {

/// Whether a face meets the intersection of at most 32 half-spaces: clipped to each in turn, in
/// double precision. What engines that only know boxes do with the faces in the volume's box.
bool meets(const Triangle& face, const std::vector<HalfSpace>& half_spaces);

}  // namespace organ_collision::bench
