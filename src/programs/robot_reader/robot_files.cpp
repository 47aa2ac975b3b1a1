#include "robot_files.hpp"

#include <ros/package.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

#include "common/messages/robot_reply.hpp"
#include "common/program/user_input.hpp"
#include "geometry/concatenate.hpp"
#include "programs/mesh_reader/mesh_reader.hpp"

namespace organ_collision {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

/// [bytes] The largest address space. It holds a file, its parsed form, and the reply to the node.
constexpr rlim_t kMemoryBytes = rlim_t{2} << 30;
/// [bytes] The longest reply to the node.
constexpr rlim_t kReplyBytes = 500'000'000;
/// [s] The most processor time. For files of the largest legal size, this program needs a few
/// seconds.
constexpr rlim_t kProcessorTime = 10;
/// [s] The most real time. On a busy machine, it is longer than processor time.
constexpr unsigned kRealTime = 30;
/// The most processor time for the URDF, and for each mesh file, is kParsingTime, and a millisecond
/// more for every kBytesPerMillisecond bytes. Some broken files keep a parser busy for ever. An OBJ
/// file is read with 30 MB a second.
constexpr std::chrono::milliseconds kParsingTime{200};
constexpr std::size_t kBytesPerMillisecond = 2000;

/// Lowers a limit of the process. A limit that is already lower stays as it is.
template <typename Resource>
void limit(Resource resource, rlim_t value) {
  rlimit limits{};
  if (getrlimit(resource, &limits) == 0) {
    limits.rlim_cur = std::min(limits.rlim_cur, value);
    if (setrlimit(resource, &limits) == 0) return;
  }
  throw std::system_error(errno, std::generic_category(), "setrlimit");
}

const std::string kPackage = "package://";
const std::string kFile = "file://";

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw InputError("'" + name + "': " + why);
}

/// Replaces the escapes of a URL, such as %41 by A. A % that is not followed by two hexadecimal
/// digits stays, and so does %00.
std::string decoded(const std::string& url) {
  std::string text;
  for (std::size_t i = 0; i < url.size(); ++i) {
    const bool is_escape = url[i] == '%' && i + 2 < url.size() &&
                           std::isxdigit(static_cast<unsigned char>(url[i + 1])) != 0 &&
                           std::isxdigit(static_cast<unsigned char>(url[i + 2])) != 0;
    const int byte = is_escape ? std::stoi(url.substr(i + 1, 2), nullptr, 16) : 0;
    text += byte == 0 ? url[i] : static_cast<char>(byte);
    if (byte != 0) i += 2;
  }
  return text;
}

std::string path_in_package(const std::string& url) {
  const std::size_t slash = url.find('/', kPackage.size());
  if (slash == std::string::npos) refuse(url, "names no file in the package");
  const std::string package = url.substr(kPackage.size(), slash - kPackage.size());
  const std::string folder = ros::package::getPath(package);
  if (folder.empty()) {
    refuse(url, "package '" + package + "' does not exist, or is not in ROS_PACKAGE_PATH");
  }
  return folder + decoded(url.substr(slash));
}

std::string path_of_url(const std::string& url) {
  const std::string path = url.substr(kFile.size());
  if (path.empty() || path[0] != '/') refuse(url, "must be file:// and an absolute path");
  return decoded(path);
}

}  // namespace

void limit_process() {
  alarm(kRealTime);
  limit(RLIMIT_FSIZE, kReplyBytes);
  limit(RLIMIT_CPU, kProcessorTime);
#ifndef ORGAN_COLLISION_SANITIZED  // Sanitizers reserve terabytes of address space.
  limit(RLIMIT_AS, kMemoryBytes);
#endif
  // RLIMIT_CORE is not enough: it has no effect where the kernel pipes core dumps to a program.
  prctl(PR_SET_DUMPABLE, 0);
}

ScopedTimeLimit::ScopedTimeLimit(std::size_t bytes) {
  const std::chrono::milliseconds more(bytes / kBytesPerMillisecond);
  const std::chrono::milliseconds time = kParsingTime + more;
  itimerval timer{};
  timer.it_value.tv_sec = time.count() / 1000;
  timer.it_value.tv_usec = time.count() % 1000 * 1000;
  if (setitimer(ITIMER_PROF, &timer, nullptr) == 0) return;
  throw std::system_error(errno, std::generic_category(), "setitimer");
}

ScopedTimeLimit::~ScopedTimeLimit() {
  const itimerval never{};
  setitimer(ITIMER_PROF, &never, nullptr);
}

std::string read_resource(const std::string& name) {
  if (boost::starts_with(name, "/")) return read_file(name);
  if (boost::starts_with(name, kPackage)) return read_file(path_in_package(name));
  if (boost::starts_with(name, kFile)) return read_file(path_of_url(name));
  // URLs of servers are refused: a server that does not answer would delay the start of the node.
  refuse(name, "must be an absolute path, or begin with package:// or file://");
}

RobotShape mesh_shape(const std::string& file, const std::string& content) {
  const ScopedTimeLimit time_limit(content.size());
  MeshFile mesh = parse_mesh(file, content);
  RobotShape shape;
  shape.kind = RobotShape::MESH;
  shape.file = file;
  shape.vertices = std::move(mesh.vertices);
  shape.triangles = std::move(mesh.triangles);
  return shape;
}

RobotShape read_mesh_file(const std::string& file, const Vector3d& scale,
                          const Affine3d& T_link_mesh) {
  if (!scale.allFinite() || (scale.array() == 0.0).any()) {
    throw ToolError(concatenate("mesh ", file, ": its scale is ", scale.transpose(),
                                "; must be finite, and not 0 along any axis"));
  }
  try {
    RobotShape shape = mesh_shape(file, read_resource(file));
    Eigen::Map<Eigen::Matrix3Xd> vertices(shape.vertices.data(), 3,
                                          static_cast<Eigen::Index>(shape.vertices.size() / 3));
    vertices = (T_link_mesh * Eigen::Scaling(scale) * vertices).eval();
    return shape;
  } catch (const std::exception& error) {
    throw ToolError(std::string("mesh ") + error.what());
  }
}

}  // namespace organ_collision
