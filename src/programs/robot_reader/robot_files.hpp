#pragma once

#include <organ_collision/RobotShape.h>

#include <Eigen/Geometry>
#include <string>

namespace organ_collision {

/// Limits the memory of this process, keeps it from dumping core, and ends it with its parent.
/// Throws std::system_error.
void limit_process();

/// The content of a regular file on this machine, as of read_file(). `name`: an absolute path, or a
/// URL that begins with package:// or file://, as in URDF. Throws InputError.
std::string read_resource(const std::string& name);

/// The surface in a mesh file with this content, as of parse_mesh(), in the units and axes of the
/// file. A broken file may end or stop the program. Throws InputError.
RobotShape mesh_shape(const std::string& file, const std::string& content);

/// The surface in a mesh file: the file, its vertices in the frame of its link
/// [m], and triangles. Lengths are multiplied by `scale`. `file`: as for read_resource(). `scale`:
/// finite and not 0 along any axis; a negative one mirrors. Throws ToolError if `scale` is illegal,
/// or the file cannot be read, and std::bad_alloc. ToolSurface checks everything else. A broken
/// file may end or stop the program.
RobotShape read_mesh_file(const std::string& file,
                          const Eigen::Vector3d& scale = Eigen::Vector3d::Ones(),
                          const Eigen::Affine3d& T_link_mesh = Eigen::Affine3d::Identity());

}  // namespace organ_collision
