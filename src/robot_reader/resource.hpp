#pragma once

#include <string>

namespace organ_collision {

/// The content of a regular file on this machine. `name`: an absolute path, or a URL that begins
/// with package:// or file://, as in URDF. Throws ToolError if there is no such file, and for
/// folders, FIFOs, devices, empty files and files larger than reader_limits::kFileBytes.
std::string read_resource(const std::string& name);

}  // namespace organ_collision
