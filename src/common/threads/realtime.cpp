#include "realtime.hpp"

#include <linux/capability.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace organ_collision {
namespace {

constexpr pid_t kThisThread = 0;

/// [niceness] How much the niceness of background threads grows. Linux limits the sum to 19.
constexpr int kBackgroundNiceness = 10;
constexpr int kMostNiceness = 19;

bool make_realtime(pid_t thread, int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return sched_setscheduler(thread, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) == 0;
}

/// Whether the calling thread may lock more memory than RLIMIT_MEMLOCK says (CAP_IPC_LOCK).
bool is_above_limits() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct sets[_LINUX_CAPABILITY_U32S_3]{};
  if (syscall(SYS_capget, &header, sets) != 0) return false;
  return (sets[CAP_TO_INDEX(CAP_IPC_LOCK)].effective & CAP_TO_MASK(CAP_IPC_LOCK)) != 0;
}

/// [MiB] How much memory of the process is locked in RAM.
double locked_memory() {
  std::ifstream status("/proc/self/status");
  double kilobytes = 0.0;
  for (std::string word; status >> word;) {
    if (word == "VmLck:" && status >> kilobytes) break;
  }
  return kilobytes / 1024.0;
}

/// How the calling thread is scheduled, such as "SCHED_FIFO, priority 40" or "ordinary".
std::string scheduling_of_this_thread() {
  sched_param parameters{};
  sched_getparam(kThisThread, &parameters);
  const int policy = sched_getscheduler(kThisThread) & ~SCHED_RESET_ON_FORK;
  if (policy != SCHED_FIFO && policy != SCHED_RR) return "ordinary";
  return std::string(policy == SCHED_FIFO ? "SCHED_FIFO" : "SCHED_RR") + ", priority " +
         std::to_string(parameters.sched_priority);
}

/// Keeps all memory of the process in RAM until the process ends. Returns an empty text, or why the
/// system refused. If the user's locked memory is limited, that counts as a refusal: beyond the
/// limit, the process would get no more memory at all.
std::string lock_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur != RLIM_INFINITY && !is_above_limits()) {
    return "locked memory is limited to " + std::to_string(limit.rlim_cur / 1024) + " kB";
  }
  // Memory that the process takes later is locked page by page, when a page is first used.
  // Otherwise a peer could lock a gigabyte: roscpp reserves as much memory as a peer announces.
  const bool is_locked = mlockall(MCL_CURRENT) == 0 && mlockall(MCL_FUTURE | MCL_ONFAULT) == 0;
  return is_locked ? std::string() : std::strerror(errno);
}

}  // namespace

std::string make_this_thread_realtime(int priority) {
  return make_realtime(kThisThread, priority) ? std::string() : std::strerror(errno);
}

// On Linux, each thread has its own niceness: these calls change that of the calling thread alone.

void lower_priority_of_this_thread() {
  setpriority(PRIO_PROCESS, kThisThread,
              getpriority(PRIO_PROCESS, kThisThread) + kBackgroundNiceness);
}

void yield_to_all_threads() { setpriority(PRIO_PROCESS, kThisThread, kMostNiceness); }

Realtime::Realtime(const RealtimeParameters& parameters) : parameters_(parameters) {
  const auto note = [this](const std::string& what, const std::string& refusal,
                           const std::string& cure) {
    if (refusal.empty()) return;
    refusals_.push_back(what + " is refused: " + refusal + "; the node goes on" + cure);
    ROS_WARN("%s", refusals_.back().c_str());
  };
  if (parameters.priority != 0) {
    const std::string priority = std::to_string(parameters.priority);
    note("realtime_priority " + priority, make_this_thread_realtime(parameters.priority),
         " with ordinary scheduling. Set the user's limit rtprio to at least " + priority);
  }
  if (parameters.lock_memory) {
    note("lock_memory", lock_memory(), " without it. Set the user's limit memlock to unlimited");
  }
}

void Realtime::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const std::string scheduling = scheduling_of_this_thread();
  status.summary(DiagnosticStatus::OK, scheduling);
  status.add("scheduling", scheduling);
  if (parameters_.lock_memory) {  // Shown only then, because reading it takes time.
    status.add("locked memory of the process [MiB]", locked_memory());
  }
  for (const std::string& refusal : refusals_) status.mergeSummary(DiagnosticStatus::WARN, refusal);
}

void make_ros_realtime(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  const int priority = private_node.param(kRealtimePriority, 0);
  if (priority == 0) return;
  // roscpp starts its timer thread with the first timer, and keeps it when that timer ends.
  node.createSteadyTimer(ros::WallDuration(1.0), [](const ros::SteadyTimerEvent&) {});
  // If the system refuses, nothing is said here, because class Realtime reports it.
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    make_realtime(std::stoi(thread.path().filename()), priority);
  }
}

}  // namespace organ_collision
