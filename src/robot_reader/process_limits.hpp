#pragma once

#include <chrono>

namespace organ_collision {

/// Applies reader_limits to this process, and stops it from dumping core. Throws std::system_error.
void limit_process();

/// Ends this process, by the signal SIGPROF, if it takes so much processor time from now on until
/// this is destroyed. There may be only one at a time. The constructor throws std::system_error.
class ScopedTimeLimit {
 public:
  explicit ScopedTimeLimit(std::chrono::milliseconds time);
  ~ScopedTimeLimit();
  ScopedTimeLimit(const ScopedTimeLimit&) = delete;
  ScopedTimeLimit& operator=(const ScopedTimeLimit&) = delete;
};

}  // namespace organ_collision
