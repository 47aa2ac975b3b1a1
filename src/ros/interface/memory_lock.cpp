#include "memory_lock.hpp"

#include <linux/capability.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace organ_collision {
namespace {

/// Whether the calling thread may lock more memory than the limit.
bool is_above_limits() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct sets[_LINUX_CAPABILITY_U32S_3]{};
  if (syscall(SYS_capget, &header, sets) != 0) return false;
  return (sets[CAP_TO_INDEX(CAP_IPC_LOCK)].effective & CAP_TO_MASK(CAP_IPC_LOCK)) != 0;
}

}  // namespace

std::string lock_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur != RLIM_INFINITY && !is_above_limits()) {
    return "locked memory is limited to " + std::to_string(limit.rlim_cur / 1024) + " kB";
  }
  // What the process takes later is locked page by page, as it is used: roscpp reserves as much
  // memory as a peer announces, up to a gigabyte for each connection.
  const bool is_locked = mlockall(MCL_CURRENT) == 0 && mlockall(MCL_FUTURE | MCL_ONFAULT) == 0;
  return is_locked ? std::string() : std::strerror(errno);
}

long long locked_memory() {
  std::ifstream status("/proc/self/status");
  constexpr long long kBytesOfUnit = 1024;
  for (std::string word; status >> word;) {
    long long amount = 0;
    if (word == "VmLck:" && status >> amount) return amount * kBytesOfUnit;
  }
  return 0;
}

}  // namespace organ_collision
