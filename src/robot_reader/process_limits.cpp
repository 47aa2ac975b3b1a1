#include "process_limits.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "ros/tools/reader_limits.hpp"

// GCC defines macros for sanitizers. clang has __has_feature instead.
#ifndef __has_feature
#define __has_feature(feature) 0
#endif

namespace organ_collision {
namespace {

/// AddressSanitizer and ThreadSanitizer reserve terabytes of address space, so they need RLIMIT_AS
/// to stay as it is.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || \
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

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

/// Zero: never. Returns whether it succeeded.
bool set_timer(std::chrono::milliseconds time) {
  itimerval timer{};
  timer.it_value.tv_sec = time.count() / 1000;
  timer.it_value.tv_usec = time.count() % 1000 * 1000;
  return setitimer(ITIMER_PROF, &timer, nullptr) == 0;
}

}  // namespace

ScopedTimeLimit::ScopedTimeLimit(std::chrono::milliseconds time) {
  if (!set_timer(time)) throw std::system_error(errno, std::generic_category(), "setitimer");
}

ScopedTimeLimit::~ScopedTimeLimit() { set_timer(std::chrono::milliseconds::zero()); }

void limit_process() {
  limit(RLIMIT_CPU, reader_limits::kProcessorTime.count());
  if (!kSanitized) limit(RLIMIT_AS, reader_limits::kMemoryBytes);
  // Not RLIMIT_CORE: it has no effect where the kernel pipes core dumps to a program.
  prctl(PR_SET_DUMPABLE, 0);
}

}  // namespace organ_collision
