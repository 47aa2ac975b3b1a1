#pragma once

#include <string>

namespace organ_collision {

/// The content of a regular file on this machine. `name`: its absolute path, or a URL as URDF has
/// them: package:// or file://. Throws ToolError where there is none, and for folders, FIFOs,
/// devices, empty files and those larger than reader_limits::kFileBytes.
std::string read_resource(const std::string& name);

}  // namespace organ_collision
