#pragma once

#include <string>
#include <vector>

#include "link_description.hpp"

namespace organ_collision {

// Both functions return links of a robot, in the order of `links`, from its URDF and the mesh files
// that the URDF names. A separate program, robot_reader, reads these files, because the libraries
// that parse them crash or hang on broken ones. Both throw ToolError, which names the file, if a
// link does not exist, if a shape or mesh cannot be read, or if the program fails or exceeds
// reader_limits.

/// `urdf`: an absolute path, or a URL (package://, file://).
std::vector<LinkDescription> read_robot_file(const std::string& urdf,
                                             const std::vector<std::string>& links);
/// `urdf`: the text itself.
std::vector<LinkDescription> read_robot_text(const std::string& urdf,
                                             const std::vector<std::string>& links);

}  // namespace organ_collision
