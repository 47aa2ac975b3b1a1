#pragma once

#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision::oracle {

/// Whether a face has a point in all half-spaces, by exact arithmetic. The half-spaces are relative
/// to `origin` [m].
bool meets(const Triangle& face, const Eigen::Vector3d& origin,
           const std::vector<HalfSpace>& half_spaces);

/// The half-spaces of a volume, each moved outward by `share` times the error of 32-bit clipping.
/// For coordinates up to `extent` [m], this error is 16 roundings of the largest coordinate,
/// measured from the eye of a perspective camera, and far / near times as much at its far plane.
std::vector<HalfSpace> half_spaces(const ViewingVolume& volume, double extent, double share);

}  // namespace organ_collision::oracle
