#pragma once

#include "ros/interface/program_help.hpp"

namespace organ_collision {

/// What --help of contact_adapter says. doc/forces.md explains the same names at length; a test
/// compares both.
ProgramHelp contact_adapter_help();

}  // namespace organ_collision
