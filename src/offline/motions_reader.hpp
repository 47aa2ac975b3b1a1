#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// One line of a motions file: the motion of a tool with a resting trocar, and the kind of query.
struct Motion {
  std::string query;  ///< its name in the file; printed with its contacts
  std::size_t line;   ///< its line in the file, from 1
  QueryMode mode;
  ToolPath path;  ///< in the mesh's frame [m]; one waypoint in the static modes
  double radius;  ///< [m]
};

/// Reads a CSV file with the columns query, mode, trocar_x, trocar_y, trocar_z, previous_x,
/// previous_y, previous_z, tip_x, tip_y, tip_z, radius, in this order. A header line may come
/// first; blank lines are skipped. Modes: static, swept, paper_static, paper_swept, paper_naive.
/// The static modes ignore the previous tip, which may be left empty. Returns the motions sorted by
/// query: by value if all queries are integers, else as text. Throws InputError if the file is
/// missing, is not legal or has no motion, or if two motions have the same query.
std::vector<Motion> read_motions(const std::string& file);

}  // namespace organ_collision
