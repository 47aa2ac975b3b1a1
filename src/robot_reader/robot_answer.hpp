#pragma once

#include <functional>
#include <string>
#include <vector>

namespace organ_collision {

/// Answers the node: reads the shapes of these links, and writes the records of robot_reply.hpp.
/// `urdf`: the text of the URDF. A file that cannot be read gives a refusal. A broken one may end
/// the program; the last record then names it.
void answer_with_links(const std::function<std::string()>& urdf,
                       const std::vector<std::string>& links,
                       const std::function<void(const std::string&)>& write);

}  // namespace organ_collision
