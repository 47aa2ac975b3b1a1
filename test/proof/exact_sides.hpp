#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision::oracle {

/// All answers are those for points that are moved by (h, h^2, h^3) with h = 2^-4000. This is a
/// vector like any other: points and faces are in general position, and no case is special. All
/// faces are looked at, and no number is divided or rounded.

/// A crossing of the moved axis.
struct ExactCrossing {
  std::uint32_t face;
  int direction;
  double shaft;                 ///< rounded
  Eigen::Vector3d barycentric;  ///< rounded
};

/// In the exact order from trocar to tip. Of faces that lie on each other, those that the axis
/// leaves come first.
std::vector<ExactCrossing> exact_crossings(const std::vector<Triangle>& faces,
                                           const ShaftAxis& axis);

/// The winding number about the moved point, by a ray in an arbitrary direction.
int exact_winding(const std::vector<Triangle>& faces, const Eigen::Vector3d& point);

/// Whether the point itself is a convex combination of the face's corners.
bool is_exactly_on(const Triangle& face, const Eigen::Vector3d& point);

/// The sign of u · (v × w) for u = points[1] - points[0], v = points[3] - points[2] and
/// w = points[5] - points[4].
int exact_triple_sign(const std::array<Eigen::Vector3d, 6>& points);

/// Whether a face has a point in all half-spaces, by exact arithmetic. The half-spaces are relative
/// to `origin` [m].
bool meets(const Triangle& face, const Eigen::Vector3d& origin,
           const std::vector<HalfSpace>& half_spaces);

/// The half-spaces of a volume, each moved outward by `share` times the error of 32-bit clipping.
/// For coordinates up to `extent` [m], this error is 16 roundings of the largest coordinate,
/// measured from the eye of a perspective camera, and far / near times as much at its far plane.
std::vector<HalfSpace> half_spaces(const ViewingVolume& volume, double extent, double share);

}  // namespace organ_collision::oracle
