#pragma once

#include <vector>

#include "geometry/half_space.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "volume_query.hpp"

namespace organ_collision::bench {

/// The box around what the volume and the organ's box have in common: what is worth asking a tree
/// of boxes about, as a tool is mostly outside of the organ.
Eigen::AlignedBox3d box_within_organ(const VolumeQuery& query);

/// Whether a face meets the intersection of at most 32 half-spaces: clipped to each in turn, in
/// double precision. What engines that only know boxes do with the faces in the volume's box.
bool meets(const Triangle& face, const std::vector<HalfSpace>& half_spaces);

}  // namespace organ_collision::bench
