#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
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

/// Already scaled, and in the link's frame.
struct MeshDescription {
  std::string file;  ///< as the URDF names it
  std::vector<Eigen::Vector3d> vertices;
  std::vector<FaceIndices> triangles;
};

/// The axis of a cylinder is z. The origin is the centre.
enum class ShapeKind { kSphere, kCylinder, kBox, kMesh };

struct ShapeDescription {
  ShapeKind kind = ShapeKind::kSphere;
  ShapePose pose = {};  ///< not of a mesh
  /// [m] Of a sphere: its radius. Of a cylinder: its radius and length. Of a box: along x, y and z.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  MeshDescription mesh = {};
};

struct LinkDescription {
  std::string joint;  ///< moves the link relative to its parent; empty: fixed, or the root
  std::vector<ShapeDescription> shapes;
};

// What the program robot_reader writes to the node: messages of the type RobotRecord, one after the
// other. Before it reads a file, it writes the name of the file, so that the node can say which
// file ended the program. At the end it writes the links, or why it has none.

std::string reading_record(const std::string& what);
std::string refusal_record(const std::string& why);
std::string links_record(const std::vector<LinkDescription>& links);

/// Either `refusal` or `links` is set; neither, if the reply is cut off or malformed.
struct RobotReply {
  std::string reading;  ///< the file that was being read last; empty: the URDF itself
  std::optional<std::string> refusal;
  std::optional<std::vector<LinkDescription>> links;
};

/// Safe for any bytes: whatever is not exactly one complete reply is malformed.
RobotReply parse_reply(const std::string& bytes);

/// What reading a robot's description may cost. The program robot_reader sets limits for itself.
/// The node enforces the last two on the program.
namespace reader_limits {

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

}  // namespace reader_limits

}  // namespace organ_collision
