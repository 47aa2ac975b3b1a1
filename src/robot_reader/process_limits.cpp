#include "process_limits.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "organ_collision/ros/reader_limits.hpp"

namespace organ_collision {
namespace {

/// Limits that are lower already stay as they are.
template <typename Resource>
void limit(Resource resource, rlim_t value) {
  rlimit limits{};
  if (getrlimit(resource, &limits) == 0) {
    limits.rlim_cur = std::min(limits.rlim_cur, value);
    if (setrlimit(resource, &limits) == 0) return;
  }
  throw std::system_error(errno, std::generic_category(), "setrlimit");
}

}  // namespace

void limit_process() {
  limit(RLIMIT_CPU, reader_limits::kProcessorTime.count());
#ifndef __SANITIZE_ADDRESS__  // AddressSanitizer itself takes terabytes.
  limit(RLIMIT_AS, reader_limits::kMemoryBytes);
#endif
  // Also where cores go to a program, which RLIMIT_CORE does not bind.
  prctl(PR_SET_DUMPABLE, 0);
}

}  // namespace organ_collision
