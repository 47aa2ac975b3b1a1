#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "convex_solid.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision::bench {

/// The question that every engine answers: which faces meet this convex volume? In the forms that
/// engines take it; making these is not timed, for none of them.
struct VolumeQuery {
  /// `organ`: a box that holds the organ in all its shapes [m].
  VolumeQuery(const ShaftMotion& motion, double radius, const Eigen::AlignedBox3d& organ);

  ShaftMotion motion;
  double radius;                       ///< [m]
  double extent;                       ///< [m] largest coordinate of the organ from the trocar
  ViewingVolume volume;                ///< the conservative one
  std::vector<HalfSpace> half_spaces;  ///< the same, in the organ's frame
  ConvexSolid solid;                   ///< the same again
  Eigen::AlignedBox3d organ;
};

}  // namespace organ_collision::bench
