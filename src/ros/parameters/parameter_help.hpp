#pragma once

#include <vector>

#include "ros/interface/program_help.hpp"

namespace organ_collision {

/// One entry for each parameter of the node, for --help and dynamic_reconfigure.
std::vector<HelpEntry> parameter_help();

}  // namespace organ_collision
