#include "robot_files.hpp"

#include <ros/package.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cctype>
#include <cerrno>
#include <csignal>
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

/// [bytes] The largest address space. It holds a file, its parsed form, and the reply.
constexpr rlim_t kMemoryBytes = rlim_t{2} << 30;

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
#ifndef ORGAN_COLLISION_SANITIZED  // Sanitizers reserve terabytes of address space.
  rlimit limits{};
  getrlimit(RLIMIT_AS, &limits);
  limits.rlim_cur = std::min(limits.rlim_cur, kMemoryBytes);
  if (setrlimit(RLIMIT_AS, &limits) != 0) {
    throw std::system_error(errno, std::generic_category(), "setrlimit");
  }
#endif
  // RLIMIT_CORE is not enough: it has no effect where the kernel pipes core dumps to a program.
  prctl(PR_SET_DUMPABLE, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
}

std::string read_resource(const std::string& name) {
  if (boost::starts_with(name, "/")) return read_file(name);
  if (boost::starts_with(name, kPackage)) return read_file(path_in_package(name));
  if (boost::starts_with(name, kFile)) return read_file(path_of_url(name));
  // URLs of servers are refused: a server that does not answer would delay the start of the node.
  refuse(name, "must be an absolute path, or begin with package:// or file://");
}

RobotShape mesh_shape(const std::string& file, const std::string& content) {
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
  } catch (const std::runtime_error& error) {
    throw ToolError(std::string("mesh ") + error.what());
  }
}

}  // namespace organ_collision
