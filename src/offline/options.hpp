#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "organ_collision/picking/picker_settings.hpp"

namespace organ_collision {

/// The name of standard input on the command line.
inline const std::string kStandardInput = "-";

/// The options on the command line of query_offline.
struct Options {
  std::string mesh;         ///< empty: the shapes of a folder
  std::string mesh_before;  ///< empty: the organ rests
  std::string shapes;       ///< a folder with a mesh for each motion; empty: one mesh for all
  std::string motions;      ///< a file, or kStandardInput
  PickerSettings picker;
  double margin = 0.0;       ///< [m] up to which the clearance is asked for; 0: not asked for
  bool clearance = false;    ///< whether the clearance is asked for without a limit
  bool placement = false;    ///< whether sides and crossings are asked for
  bool blank_lines = false;  ///< whether a blank line follows the answer to each motion
  std::size_t jobs = 1;      ///< the number of threads
  bool help = false;
};

/// Reads the command line. `arguments` exclude the program's name. Throws InputError for options
/// that are unknown, repeated, without value or missing, and for illegal values. If --help is among
/// them, the others are not checked.
Options parse_options(const std::vector<std::string>& arguments);

/// What --help prints.
std::string usage();

}  // namespace organ_collision
