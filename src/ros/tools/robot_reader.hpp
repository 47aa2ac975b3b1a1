#pragma once

#include <string>
#include <vector>

#include "link_description.hpp"

namespace organ_collision {

// The links of a robot, in the order of `links`, from its URDF and the mesh files that it names. A
// separate program, robot_reader, reads these files, because the libraries that parse them crash or
// hang on broken ones. Both functions throw ToolError, which names the file, if there is no such
// link, if a shape or mesh cannot be read, or if the program exceeds reader_limits or ends
// otherwise.

/// `urdf`: an absolute path, or a URL (package://, file://).
std::vector<LinkDescription> read_robot_file(const std::string& urdf,
                                             const std::vector<std::string>& links);
/// `urdf`: the text itself.
std::vector<LinkDescription> read_robot_text(const std::string& urdf,
                                             const std::vector<std::string>& links);

}  // namespace organ_collision
