#pragma once

#include <organ_collision/RobotLink.h>

#include <chrono>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace organ_collision {

/// The links of a tool cannot be made from a robot's description. what() names the file, link or
/// value, and what is legal.
class ToolError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What the program robot_reader writes to the node: messages of the type RobotRecord, one after the
// other. Before it reads a file, it writes the name of the file, so that the node can say which
// file ended the program. At the end it writes the links, or why it has none.

std::string reading_record(const std::string& what);
std::string refusal_record(const std::string& why);
std::string links_record(std::vector<RobotLink> links);

/// Either `refusal` or `links` is set; neither, if the reply is cut off or malformed.
struct RobotReply {
  std::string reading;  ///< the file that was being read last; empty: the URDF itself
  std::optional<std::string> refusal;
  std::optional<std::vector<RobotLink>> links;  ///< their values are not checked yet
};

/// Safe for any bytes: whatever is not exactly one complete reply is malformed.
RobotReply parse_reply(const std::string& bytes);

/// What reading a robot's description may cost. The program robot_reader sets limits for itself.
/// The node enforces the last two on the program.
namespace reader_limits {

/// [bytes] The largest size of the URDF, and of each mesh file. An STL file of two million
/// triangles has this size.
inline constexpr std::size_t kFileBytes = 100'000'000;
/// [bytes] The largest address space of robot_reader. It holds a file, its parsed form, and the
/// reply to the node.
inline constexpr std::size_t kMemoryBytes = std::size_t{2} << 30;
/// The most processor time of robot_reader. Files of the largest legal size take a few seconds.
inline constexpr std::chrono::seconds kProcessorTime{10};
/// The most processor time for one mesh file: this, and some more for each byte. An OBJ file is
/// read with 30 MB a second. Parsers never stop reading some broken files.
inline constexpr std::chrono::milliseconds kMeshTime{200};
inline constexpr std::size_t kMeshBytesPerMillisecond = 2000;

/// The most real time of robot_reader, which is longer than processor time on a busy machine.
inline constexpr std::chrono::seconds kTime{30};
inline constexpr std::size_t kReplyBytes = 500'000'000;

}  // namespace reader_limits

}  // namespace organ_collision
