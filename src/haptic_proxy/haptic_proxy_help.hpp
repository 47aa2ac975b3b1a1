#pragma once

#include "ros/interface/program_help.hpp"

namespace organ_collision {

/// What --help of haptic_proxy says. doc/haptic_interface.md explains the same names at length; a
/// test compares both.
ProgramHelp haptic_proxy_help();

}  // namespace organ_collision
