#pragma once

#include <optional>
#include <string>
#include <vector>

#include "link_description.hpp"

namespace organ_collision {

// What the program robot_reader writes: first, again and again, what it is about to read, so that
// the node knows what ended it; at last the links, or why there are none. In the machine's own byte
// order, as both run on the same one.

std::string reading_record(const std::string& what);
std::string refusal_record(const std::string& why);
std::string links_record(std::vector<LinkDescription> links);

/// Of `refusal` and `links` one is there, or none where the reply is cut off or malformed.
struct RobotReply {
  std::string reading;  ///< what was read last; empty: the URDF itself
  std::optional<std::string> refusal;
  std::optional<std::vector<LinkDescription>> links;
};

/// Any bytes do no harm: what is not all of a reply and nothing else is malformed.
RobotReply parse_reply(const std::string& bytes);

}  // namespace organ_collision
