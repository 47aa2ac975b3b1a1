#pragma once

#include "ros/parameters/program_help.hpp"

namespace organ_collision {

/// What --help of organ_collision_node says. doc/interface.md explains the same names at length; a
/// test compares both.
ProgramHelp node_help();

}  // namespace organ_collision
