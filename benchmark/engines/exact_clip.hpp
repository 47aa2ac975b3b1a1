#pragma once

#include <cstdint>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "benchmark/scenes/volume_query.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision::bench {

/// The bounding box of the part of the volume inside the organ's box. Engines with a tree of boxes
/// are asked about this box: most of a tool's volume is outside of the organ.
Eigen::AlignedBox3d box_within_organ(const VolumeQuery& query);

/// Whether a face meets the intersection of at most 32 half-spaces. The face is clipped to each
/// half-space in turn, in double precision.
bool meets(const Triangle& face, const std::vector<HalfSpace>& half_spaces);

/// Removes from `faces` the faces that do not meet the volume, and sorts the rest. On entry,
/// `faces` are the faces that a tree found in the volume's box.
void keep_faces_that_meet(const VolumeQuery& query, const OrganSurface& organ,
                          const std::vector<float>& vertices, std::vector<std::uint32_t>& faces);

}  // namespace organ_collision::bench
