#include "resource.hpp"

#include <ros/package.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "geometry/concatenate.hpp"
#include "ros/tools/robot_reply.hpp"

namespace organ_collision {
namespace {

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

/// Makes SIGPROF end the process after this processor time; zero: never. Returns false if that
/// fails.
bool set_timer(std::chrono::milliseconds time) {
  itimerval timer{};
  timer.it_value.tv_sec = time.count() / 1000;
  timer.it_value.tv_usec = time.count() % 1000 * 1000;
  return setitimer(ITIMER_PROF, &timer, nullptr) == 0;
}

const std::string kPackage = "package://";
const std::string kFile = "file://";

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw ToolError("cannot read '" + name + "': " + why);
}

/// The content of a regular file. Follows symbolic links. Throws ToolError.
std::string read_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error == std::errc::no_such_file_or_directory) refuse(path, "there is no such file");
  if (error) refuse(path, error.message());
  if (fs::is_directory(status)) refuse(path, "it is a folder");
  if (!fs::is_regular_file(status)) {
    refuse(path, "it is a FIFO, device or socket; must be a regular file");
  }
  const auto size = static_cast<std::size_t>(fs::file_size(path));
  if (size == 0) refuse(path, "it is empty");
  if (size > reader_limits::kFileBytes) {
    refuse(path, concatenate("it has ", size, " bytes; at most ", reader_limits::kFileBytes,
                             " are read"));
  }
  std::string content(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(content.data(), static_cast<std::streamsize>(size))) {
    refuse(path, std::strerror(errno));
  }
  return content;
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

ScopedTimeLimit::ScopedTimeLimit(std::chrono::milliseconds time) {
  if (!set_timer(time)) throw std::system_error(errno, std::generic_category(), "setitimer");
}

ScopedTimeLimit::~ScopedTimeLimit() { set_timer(std::chrono::milliseconds::zero()); }

void limit_process() {
  limit(RLIMIT_CPU, reader_limits::kProcessorTime.count());
#ifndef ORGAN_COLLISION_SANITIZED  // Sanitizers reserve terabytes of address space.
  limit(RLIMIT_AS, reader_limits::kMemoryBytes);
#endif
  // RLIMIT_CORE is not enough: it has no effect where the kernel pipes core dumps to a program.
  prctl(PR_SET_DUMPABLE, 0);
}

std::string read_resource(const std::string& name) {
  if (boost::starts_with(name, "/")) return read_file(name);
  if (boost::starts_with(name, kPackage)) return read_file(path_in_package(name));
  if (boost::starts_with(name, kFile)) return read_file(path_of_url(name));
  // URLs of servers are refused: a server that does not answer would delay the start of the node.
  refuse(name, "must be an absolute path, or begin with package:// or file://");
}

}  // namespace organ_collision
