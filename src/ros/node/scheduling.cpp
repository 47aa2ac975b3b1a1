#include "scheduling.hpp"

#include <fcntl.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace organ_collision {
namespace {

constexpr pid_t kThisThread = 0;

/// Returns the number of the system's error, or 0.
int make_realtime(pid_t thread, int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int flags = SCHED_FIFO | SCHED_RESET_ON_FORK;
  return sched_setscheduler(thread, flags, &parameters) == 0 ? 0 : errno;
}

/// [niceness] The system makes it at most 19.
constexpr int kBackgroundNiceness = 10;
constexpr int kMostNiceness = 19;

/// On Linux, each thread has a niceness of its own.
void set_niceness(int niceness) { setpriority(PRIO_PROCESS, kThisThread, niceness); }

std::string error_text(int error) { return error == 0 ? std::string() : std::strerror(error); }

}  // namespace

std::string make_this_thread_realtime(int priority) {
  return error_text(make_realtime(kThisThread, priority));
}

std::string make_all_threads_realtime(int priority) {
  for (const pid_t thread : threads_of_this_process()) {
    const int error = make_realtime(thread, priority);
    const bool has_ended = error == ESRCH;  // Since the list was made.
    if (error != 0 && !has_ended) return error_text(error);
  }
  return {};
}

void lower_priority_of_this_thread() {
  set_niceness(getpriority(PRIO_PROCESS, kThisThread) + kBackgroundNiceness);
}

void yield_to_all_threads() { set_niceness(kMostNiceness); }

std::string scheduling_of_this_thread() {
  sched_param parameters{};
  sched_getparam(kThisThread, &parameters);
  const int policy = sched_getscheduler(kThisThread) & ~SCHED_RESET_ON_FORK;
  const std::string priority = ", priority " + std::to_string(parameters.sched_priority);
  if (policy == SCHED_FIFO) return "SCHED_FIFO" + priority;
  if (policy == SCHED_RR) return "SCHED_RR" + priority;
  return "ordinary";
}

std::vector<pid_t> threads_of_this_process() {
  std::vector<pid_t> threads;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
    threads.push_back(std::stoi(entry.path().filename()));
  }
  return threads;
}

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

namespace {

constexpr std::int32_t kLongestWaking = 0;  // [us]

}  // namespace

AwakeCores::AwakeCores() : request_(open("/dev/cpu_dma_latency", O_RDWR | O_CLOEXEC)) {
  const bool is_accepted = request_ >= 0 && write(request_, &kLongestWaking,
                                                  sizeof kLongestWaking) == sizeof kLongestWaking;
  if (!is_accepted) refusal_ = std::strerror(errno);
}

AwakeCores::~AwakeCores() {
  if (request_ >= 0) close(request_);
}

}  // namespace organ_collision
