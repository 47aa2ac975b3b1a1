#pragma once

#include <optional>
#include <string>
#include <vector>

#include "link_description.hpp"

namespace organ_collision {

// What the program robot_reader writes to the node. Before it reads a file, it writes the name of
// the file, so that the node can say which file ended the program. At the end it writes the links,
// or why it has none. Numbers are in native byte order: both programs run on the same machine.

std::string reading_record(const std::string& what);
std::string refusal_record(const std::string& why);
std::string links_record(std::vector<LinkDescription> links);

/// Either `refusal` or `links` is set; neither, if the reply is cut off or malformed.
struct RobotReply {
  std::string reading;  ///< the file that was being read last; empty: the URDF itself
  std::optional<std::string> refusal;
  std::optional<std::vector<LinkDescription>> links;
};

/// Safe for any bytes: whatever is not exactly one complete reply is malformed.
RobotReply parse_reply(const std::string& bytes);

}  // namespace organ_collision
