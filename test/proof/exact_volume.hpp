#pragma once

#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision::oracle {

/// Whether a face, in coordinates shifted to `origin`, has a point in all half-spaces, exactly.
bool meets(const Triangle& face, const Eigen::Vector3d& origin,
           const std::vector<HalfSpace>& half_spaces);

/// The half-spaces of a volume, each moved outward by `share` of what 32-bit clipping may misplace
/// it for coordinates up to `extent` [m]: 16 roundings of the largest coordinate, seen from a
/// perspective camera's eye, which at its far plane count far / near times.
std::vector<HalfSpace> half_spaces(const ViewingVolume& volume, double extent, double share);

}  // namespace organ_collision::oracle
