#pragma once

#include <string>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "ros/parameters/node_parameters.hpp"

namespace organ_collision {

/// A tool as the node uses it.
struct Tool {
  ToolParameters parameters;
  std::vector<Link> links;          ///< in the order of parameters.links
  std::vector<std::string> joints;  ///< that move them, for each link; empty: fixed, or the root
  std::string fault;  ///< why its links could not be loaded; empty: they were, or it has none
};

}  // namespace organ_collision
