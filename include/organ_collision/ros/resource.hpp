#pragma once

#include <string>

namespace organ_collision {

/// The content of a file. `name`: its absolute path, or a URL as URDF has them: package://, file://
/// or http://. Throws ToolError where there is none.
std::string read_resource(const std::string& name);

}  // namespace organ_collision
