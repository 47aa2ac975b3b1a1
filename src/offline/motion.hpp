#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// The motion of a tool with a resting trocar, and the kind of query: one line of a motions file.
struct Motion {
  std::string query;     ///< its name, which is printed with its contacts
  std::size_t line = 0;  ///< where it was read, from 1
  QueryMode mode = QueryMode::kStatic;
  Eigen::Vector3d trocar;    ///< in the mesh's frame [m], as the two that follow
  Eigen::Vector3d previous;  ///< the tip at the start; the same as `tip` in the static modes
  Eigen::Vector3d tip;       ///< at the end
  double radius = 0.0;       ///< [m]
};

/// Where a tool was during its motion: one waypoint in the static modes, else two.
ToolPath path_of(const Motion& motion);

/// Throws std::invalid_argument, naming the value and what is legal, if CollisionQuery has no
/// answer to a motion, whatever the organ is.
void check(const Motion& motion);

}  // namespace organ_collision
