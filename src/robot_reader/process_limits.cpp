#include "process_limits.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "ros/tools/reader_limits.hpp"

// GCC has macros that say so, and clang has features.
#ifndef __has_feature
#define __has_feature(feature) 0
#endif

namespace organ_collision {
namespace {

/// AddressSanitizer and ThreadSanitizer themselves take terabytes of address space.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || \
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

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
  if (!kSanitized) limit(RLIMIT_AS, reader_limits::kMemoryBytes);
  // Also where cores go to a program, which RLIMIT_CORE does not bind.
  prctl(PR_SET_DUMPABLE, 0);
}

}  // namespace organ_collision
