#pragma once

#include <chrono>
#include <string>

namespace organ_collision {

/// Applies reader_limits to this process, and stops it from dumping core. Throws std::system_error.
void limit_process();

/// While an object of this class lives, this process may take at most `time` of processor time. The
/// signal SIGPROF ends it after that. Only one such object may exist at a time. The constructor
/// throws std::system_error.
class ScopedTimeLimit {
 public:
  explicit ScopedTimeLimit(std::chrono::milliseconds time);
  ~ScopedTimeLimit();
  ScopedTimeLimit(const ScopedTimeLimit&) = delete;
  ScopedTimeLimit& operator=(const ScopedTimeLimit&) = delete;
};

/// The content of a regular file on this machine. `name`: an absolute path, or a URL that begins
/// with package:// or file://, as in URDF. Throws ToolError if there is no such file, and for
/// folders, FIFOs, devices, empty files and files larger than reader_limits::kFileBytes.
std::string read_resource(const std::string& name);

}  // namespace organ_collision
