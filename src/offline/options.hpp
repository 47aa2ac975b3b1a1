#pragma once

#include <string>
#include <vector>

#include "picking/pickers/picker.hpp"

namespace organ_collision {

/// What the command line of query_offline asks for.
struct Options {
  std::string mesh;
  std::string mesh_before;  ///< empty: the organ rests
  std::string motions;
  PickerKind picker = PickerKind::kFeedback;
  bool help = false;
};

/// `arguments` without the program's name; `--name value` or `--name=value`. Throws InputError for
/// options that are unknown, repeated, without value or missing. With --help nothing is required.
Options parse_options(const std::vector<std::string>& arguments);

/// What --help prints.
std::string usage();

}  // namespace organ_collision
