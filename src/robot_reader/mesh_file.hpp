#pragma once

#include <organ_collision/RobotShape.h>

#include <Eigen/Geometry>
#include <string>

namespace organ_collision {

/// The surface in a mesh file: the file, its vertices in the frame of its link [m], and triangles.
/// Reads STL, DAE, OBJ and the other formats of assimp. As in RViz, the axes are those of the file.
/// Lengths are multiplied by `scale`, and in DAE by the file's unit too. Corners at the same
/// position become one vertex. Points, lines, and other files that the file names are ignored.
/// `file`: as for read_resource(). `scale`: finite and not 0 along any axis; a negative one
/// mirrors. Throws ToolError if `scale` is illegal, the file cannot be read, or a vertex is not
/// finite. ToolSurface checks everything else, for example that there are triangles. A broken file
/// may end the program.
RobotShape read_mesh_file(const std::string& file, const Eigen::Vector3d& scale,
                          const Eigen::Affine3d& T_link_mesh);

}  // namespace organ_collision
