#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/messages/robot_reply.hpp"

namespace organ_collision {

/// Reads the links with these names. Each has the joint that moves it and all its collision shapes
/// or, if it has none, all its visual shapes. Throws ToolError if a link does not exist or cannot
/// be read, and std::bad_alloc. A broken file may end or stop the program. `urdf`: the text of the
/// URDF. `folder`: that of the URDF, with a slash at its end, from which relative names of meshes
/// begin; empty: there is none. `about_to_read`: called before a mesh is read, with its link and
/// name: "link 'jaw': mesh 'jaw.stl'".
std::vector<RobotLink> read_links(const std::string& urdf, const std::vector<std::string>& links,
                                  const std::string& folder,
                                  const std::function<void(const std::string&)>& about_to_read);

}  // namespace organ_collision
