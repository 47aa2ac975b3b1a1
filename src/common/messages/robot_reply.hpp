#pragma once

#include <organ_collision/RobotLink.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace organ_collision {

/// Thrown if the links of a tool cannot be made from a robot's description. what() names the file,
/// link or value, and what is legal.
class ToolError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// These functions make what the program robot_reader writes to the node: messages of the type
// RobotRecord, one after the other. Before the program reads a file, it writes the file's name, so
// that the node can say which file made it crash. At the end it writes the links, or why it has
// none.

std::string reading_record(const std::string& what);
std::string refusal_record(const std::string& why);
std::string links_record(std::vector<RobotLink> links);

/// The parsed reply of robot_reader. Either `refusal` or `links` is set. If the reply is cut off or
/// malformed, both are empty.
struct RobotReply {
  std::string reading;  ///< the file that was read last; empty: the URDF itself
  std::optional<std::string> refusal;
  std::optional<std::vector<RobotLink>> links;  ///< not checked yet
};

/// Parses a reply. Any bytes may be given: all that is not one complete reply is malformed.
RobotReply parse_reply(const std::string& bytes);

}  // namespace organ_collision
