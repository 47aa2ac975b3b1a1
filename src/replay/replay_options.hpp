#pragma once

#include <string>
#include <vector>

namespace organ_collision {

/// The command line of replay.
struct ReplayOptions {
  std::string in;
  std::string out;
  std::string parameters;  ///< the yaml file
  std::string node;        ///< the node's full name, under which its topics were recorded
  bool with_input = false;
  bool help = false;
};

/// `arguments` exclude the program's name. Options are given as `--name value` or `--name=value`.
/// Throws InputError for arguments that are unknown, repeated or missing. If --help is among them,
/// the others are not checked.
ReplayOptions parse_replay_options(const std::vector<std::string>& arguments);

/// What --help prints.
std::string replay_usage();

}  // namespace organ_collision
