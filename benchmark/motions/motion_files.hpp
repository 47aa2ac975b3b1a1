#pragma once

#include <cstddef>
#include <string>

#include "benchmark/scenes/motion_set.hpp"

namespace organ_collision::bench {

/// Writes into `folder` what query_offline and the node need for the same motions: organ.obj;
/// without links, `count` motions in static.csv and swept.csv, the motions of the set again and
/// again; with links, the URDF robot.urdf and the meshes of the links. Throws std::runtime_error if
/// a file cannot be written.
void write_files(const std::string& folder, const OrganSurface& organ, const MotionSet& motions,
                 std::size_t count);

}  // namespace organ_collision::bench
