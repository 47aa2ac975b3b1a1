#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"

/// The definitions of sides and crossings, decided by exact arithmetic over all faces.
namespace organ_collision::oracle {

/// A face that an axis crosses.
struct CrossedFace {
  std::size_t face;
  int direction;  ///< +1: the axis goes against the face's outward normal; -1: along it
  double place;   ///< on the axis, in [0, 1]; exact, then rounded
};

/// The faces that an axis crosses if it is moved by (e, e^2, e^3), for an infinitesimal e > 0. (It
/// is moved by a number far below every other one, so exactly this is computed.) By rising place.
std::vector<CrossedFace> crossed_faces(const ShaftAxis& axis, const std::vector<Triangle>& faces);

/// How often a closed surface encloses a point, after the same infinitesimal motion. Counted along
/// a segment to `outside`, a point that no face encloses.
int winding_number(const Eigen::Vector3d& point, const Eigen::Vector3d& outside,
                   const std::vector<Triangle>& faces);

/// Whether a point is exactly on a face.
bool lies_on(const Eigen::Vector3d& point, const std::vector<Triangle>& faces);

}  // namespace organ_collision::oracle
