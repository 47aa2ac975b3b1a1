#pragma once

#include <string>
#include <vector>

#include "link_description.hpp"

namespace organ_collision {

// Links of a robot, in the order of their names, from its URDF and the mesh files that it names.
// The program robot_reader reads them, as the libraries that it uses crash and hang on broken
// files. Both throw ToolError, which names the file: no such link, a shape or mesh that cannot be
// read, more time or memory than reader_limits, or whatever else ended the program.

/// `urdf`: an absolute path, or a URL (package://, file://).
std::vector<LinkDescription> read_robot_file(const std::string& urdf,
                                             const std::vector<std::string>& links);
/// `urdf`: the text itself.
std::vector<LinkDescription> read_robot_text(const std::string& urdf,
                                             const std::vector<std::string>& links);

}  // namespace organ_collision
