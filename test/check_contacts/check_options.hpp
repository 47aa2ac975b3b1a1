#pragma once

#include <optional>
#include <string>
#include <vector>

namespace organ_collision {

/// What check_contacts is to do.
struct CheckOptions {
  bool help = false;
  std::vector<std::string> topics;  ///< at least one
  std::optional<double> seconds;    ///< how long to watch; none: until Ctrl-C
};

/// Parses the words behind the program's name. Throws std::invalid_argument, with the illegal word
/// and what is legal.
CheckOptions parse_check_options(const std::vector<std::string>& arguments);

/// What --help prints.
std::string check_usage();

}  // namespace organ_collision
