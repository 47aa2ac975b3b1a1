#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "convex_solid.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision::bench {

/// The question that every engine answers: which faces meet this convex volume? Contains the volume
/// in every form that an engine takes. The time to make these forms is not measured.
struct VolumeQuery {
  /// `radius`: of the tool [m]. `organ`: a box around the organ in all its shapes [m].
  VolumeQuery(const ShaftMotion& motion, double radius, const Eigen::AlignedBox3d& organ);

  ShaftMotion motion;
  double radius;                       ///< [m]
  double extent;                       ///< [m] largest organ coordinate, from the trocar
  ViewingVolume volume;                ///< the conservative volume of the motion
  std::vector<HalfSpace> half_spaces;  ///< the same volume, in the organ's frame
  ConvexSolid solid;                   ///< the same volume, by its corners
  Eigen::AlignedBox3d organ;
};

}  // namespace organ_collision::bench
