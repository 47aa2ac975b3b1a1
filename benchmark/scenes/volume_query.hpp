#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_surface.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision::bench {

/// A bounded convex solid, given by its corners and sides.
struct ConvexSolid {
  std::vector<Eigen::Vector3d> corners;  ///< [m]
  std::vector<std::vector<int>>
      sides;  ///< indices of the corners of each side, anticlockwise seen from outside
};

/// The intersection of `half_spaces` [m], which must be bounded.
ConvexSolid solid_of(const std::vector<HalfSpace>& half_spaces);

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

/// The reference answer to a query. Both lists are sorted.
struct Answer {
  std::vector<std::uint32_t> faces;  ///< faces that certainly meet the volume
  std::vector<std::uint32_t> close;  ///< too close to the boundary for 32 bits: may be found or not
};

/// By the exact oracle of test/proof.
Answer brute_force_answer(const VolumeQuery& query, const OrganSurface& organ,
                          const std::vector<float>& vertices);

/// The errors in an engine's answer.
struct Errors {
  std::size_t missed = 0;  ///< faces that meet the volume and were not found
  std::size_t wrong = 0;   ///< faces found that do not meet the volume, or found twice
};

/// `found` must be sorted.
Errors compare(const std::vector<std::uint32_t>& found, const Answer& answer);

}  // namespace organ_collision::bench
