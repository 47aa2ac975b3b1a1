#pragma once

#include <functional>
#include <string>
#include <vector>

namespace organ_collision {

/// Answers the node: reads the links with these names. Each has the joint that moves it and all its
/// collision shapes or, if it has none, all its visual shapes. Writes the records of
/// robot_reply.hpp. Before it reads a mesh, it writes the mesh's name: "link 'jaw': mesh
/// 'jaw.stl'". `urdf`: returns the text of the URDF, or throws. What cannot be read gives a
/// refusal. A broken file may end the program; the last record then names it. `folder`: that of the
/// URDF, with a slash at its end, from which relative names of meshes begin; empty: there is none.
void answer_with_links(const std::function<std::string()>& urdf,
                       const std::vector<std::string>& links,
                       const std::function<void(const std::string&)>& write,
                       const std::string& folder = {});

}  // namespace organ_collision
