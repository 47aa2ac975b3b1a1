#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

/// The links of a tool cannot be made from a robot's description. what() names the file, link or
/// value, and what is legal.
class ToolError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A link as the robot's files describe it, in the link's frame. Lengths are in metres. The values
// are not checked yet: build_link does that.

/// The pose of a shape in the link's frame.
struct ShapePose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

struct SphereDescription {
  ShapePose pose;
  double radius = 0.0;
};

/// Its axis is z; the origin is its centre.
struct CylinderDescription {
  ShapePose pose;
  double radius = 0.0, length = 0.0;
};

/// `size` along x, y and z [m]; the origin is its centre.
struct BoxDescription {
  ShapePose pose;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

/// Already scaled, and in the link's frame.
struct MeshDescription {
  std::string file;  ///< as the URDF names it
  std::vector<Eigen::Vector3d> vertices;
  std::vector<FaceIndices> triangles;
};

using ShapeDescription =
    std::variant<SphereDescription, CylinderDescription, BoxDescription, MeshDescription>;

struct LinkDescription {
  std::string joint;  ///< moves the link relative to its parent; empty: fixed, or the root
  std::vector<ShapeDescription> shapes;
};

}  // namespace organ_collision

/// What reading a robot's description may cost. The program robot_reader sets limits for
/// itself. The node enforces the last two on the program.

namespace organ_collision::reader_limits {

/// [bytes] Of the URDF, and of each mesh file. An STL file of two million triangles has this size.
inline constexpr std::size_t kFileBytes = 100'000'000;
/// [bytes] Of address space: a file, its parsed form, and the reply to the node.
inline constexpr std::size_t kMemoryBytes = std::size_t{2} << 30;
/// Of processor time: files of the largest legal size take a few seconds.
inline constexpr std::chrono::seconds kProcessorTime{10};
/// Of processor time for one mesh file: this, and some more for each byte. An OBJ file is read with
/// 30 MB a second. Parsers never stop reading some broken files.
inline constexpr std::chrono::milliseconds kMeshTime{200};
inline constexpr std::size_t kMeshBytesPerMillisecond = 2000;

/// Of real time, which is longer than processor time on a busy machine.
inline constexpr std::chrono::seconds kTime{30};
inline constexpr std::size_t kReplyBytes = 500'000'000;

}  // namespace organ_collision::reader_limits

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
