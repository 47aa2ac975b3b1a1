#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// One line of a motions file: how a tool with a resting trocar moved, and what is asked about it.
struct Motion {
  std::string query;  ///< what the file calls it; printed with its contacts
  std::size_t line;   ///< in the file, from 1
  QueryMode mode;
  ToolPath path;  ///< in the mesh's frame [m]; one waypoint in the static modes
  double radius;  ///< [m]
};

/// Reads a CSV file with the columns query, mode, trocar_x, trocar_y, trocar_z, previous_x,
/// previous_y, previous_z, tip_x, tip_y, tip_z, radius, in this order. A header line may come
/// first; blank lines are skipped. Modes: static, swept, paper_static, paper_swept, paper_naive; in
/// the static ones nobody looks at the previous tip, so it may be left empty. Returns the motions
/// sorted by query: by value if all are integers, else as text. Throws InputError for a file that
/// is missing, without motions or not legal, and where two motions have the same query.
std::vector<Motion> read_motions(const std::string& file);

}  // namespace organ_collision
