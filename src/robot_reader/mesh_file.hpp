#pragma once

#include <Eigen/Geometry>
#include <string>

#include "ros/tools/link_description.hpp"

namespace organ_collision {

/// The surface in a mesh file, in its link's frame [m]. STL, DAE, OBJ and whatever else assimp
/// reads, as RViz does: in the file's own axes, lengths times `scale` and, in DAE, times the file's
/// unit. Each corner of a triangle becomes a vertex once; points and lines are left out. Files that
/// the file itself names are not read.
/// `file`: as in read_resource. `scale`: finite, not 0; negative mirrors.
/// Throws ToolError, but not for what ToolSurface refuses. A broken file may end the program.
MeshDescription read_mesh_file(const std::string& file, const Eigen::Vector3d& scale,
                               const Eigen::Affine3d& T_link_mesh);

}  // namespace organ_collision
