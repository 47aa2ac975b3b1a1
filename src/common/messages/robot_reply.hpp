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

/// What the program robot_reader writes to the node: a RobotRecord, after its number of bytes.
std::string reply_of(const std::vector<RobotLink>& links);

/// The links of a reply, which are not checked yet. None if it is cut off or malformed.
std::optional<std::vector<RobotLink>> parse_reply(const std::string& bytes);

}  // namespace organ_collision
