#pragma once

#include <organ_collision/RobotShape.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <string>

namespace organ_collision {

/// Applies reader_limits to this process, and stops it from dumping core. Throws std::system_error.
void limit_process();

/// While an object of this class lives, SIGPROF ends this process if it works on a file of so many
/// bytes for much longer than its parsers need: some broken files keep them busy for minutes, or
/// for ever. Throws std::system_error.
class ScopedTimeLimit {
 public:
  explicit ScopedTimeLimit(std::size_t bytes);
  ~ScopedTimeLimit();
  ScopedTimeLimit(const ScopedTimeLimit&) = delete;
  ScopedTimeLimit& operator=(const ScopedTimeLimit&) = delete;
};

/// The content of a regular file on this machine. `name`: an absolute path, or a URL that begins
/// with package:// or file://, as in URDF. Throws ToolError if there is no such file, and for
/// folders, FIFOs, devices, empty files and files larger than reader_limits::kFileBytes.
std::string read_resource(const std::string& name);

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
