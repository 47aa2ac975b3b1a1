#pragma once

#include "ros/interface/program_help.hpp"

namespace organ_collision {

/// What --help of organ_mesh_adapter says. doc/meshes.md explains the same names at length; a test
/// compares both.
ProgramHelp mesh_adapter_help();

}  // namespace organ_collision
