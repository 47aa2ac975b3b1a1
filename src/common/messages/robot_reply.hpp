#pragma once

#include <organ_collision/RobotLink.h>

#include <chrono>
#include <cstddef>
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

/// The most that reading a robot's description may cost. The program robot_reader sets these limits
/// for itself, before it reads a file.
namespace reader_limits {

/// [bytes] The largest address space of robot_reader. It holds a file, its parsed form, and the
/// reply to the node.
inline constexpr std::size_t kMemoryBytes = std::size_t{2} << 30;
/// The most processor time of robot_reader. For files of the largest legal size, it needs a few
/// seconds.
inline constexpr std::chrono::seconds kProcessorTime{10};
/// The most processor time for the URDF, and for each mesh file, is kParsingTime, and a millisecond
/// more for every kBytesPerMillisecond bytes. Some broken files keep a parser busy for ever. An OBJ
/// file is read with 30 MB a second.
inline constexpr std::chrono::milliseconds kParsingTime{200};
inline constexpr std::size_t kBytesPerMillisecond = 2000;

/// The most real time of robot_reader. On a busy machine, real time is longer than processor time.
inline constexpr std::chrono::seconds kTime{30};
inline constexpr std::size_t kReplyBytes = 500'000'000;

}  // namespace reader_limits

}  // namespace organ_collision
