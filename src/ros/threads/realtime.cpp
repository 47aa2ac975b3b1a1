#include "realtime.hpp"

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

/// [niceness] The system makes it at most 19.
constexpr int kBackgroundNiceness = 10;
constexpr int kMostNiceness = 19;

/// Returns the number of the system's error, or 0.
int make_realtime(pid_t thread, int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int flags = SCHED_FIFO | SCHED_RESET_ON_FORK;
  return sched_setscheduler(thread, flags, &parameters) == 0 ? 0 : errno;
}

/// On Linux, each thread has a niceness of its own.
void set_niceness(int niceness) { setpriority(PRIO_PROCESS, kThisThread, niceness); }

std::string error_text(int error) { return error == 0 ? std::string() : std::strerror(error); }

/// Whether the calling thread may lock more memory than the limit.
bool is_above_limits() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct sets[_LINUX_CAPABILITY_U32S_3]{};
  if (syscall(SYS_capget, &header, sets) != 0) return false;
  return (sets[CAP_TO_INDEX(CAP_IPC_LOCK)].effective & CAP_TO_MASK(CAP_IPC_LOCK)) != 0;
}

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

AwakeCores::AwakeCores() : request_(open("/dev/cpu_dma_latency", O_RDWR | O_CLOEXEC)) {
  constexpr std::int32_t kLongestWaking = 0;  // [us]
  const bool is_accepted = request_ >= 0 && write(request_, &kLongestWaking,
                                                  sizeof kLongestWaking) == sizeof kLongestWaking;
  if (!is_accepted) refusal_ = std::strerror(errno);
}

AwakeCores::~AwakeCores() {
  if (request_ >= 0) close(request_);
}

Realtime::Realtime(const RealtimeParameters& parameters)
    : shows_locked_memory_(parameters.lock_memory) {
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
  if (parameters.awake_cores) {
    note("awake_cores", awake_cores_.emplace().refusal(),
         ", and idle cores sleep. Permit this user to write to /dev/cpu_dma_latency");
  }
}

void Realtime::add_to(diagnostic_updater::Updater& updater) {
  updater.add("scheduling", this, &Realtime::diagnose);
}

void Realtime::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  constexpr double kMebibyte = 1024.0 * 1024.0;
  const std::string scheduling = scheduling_of_this_thread();
  status.summary(DiagnosticStatus::OK, scheduling);
  status.add("scheduling", scheduling);
  if (shows_locked_memory_) {
    status.add("locked memory of the process [MiB]",
               static_cast<double>(locked_memory()) / kMebibyte);
  }
  if (awake_cores_ && awake_cores_->refusal().empty()) status.add("idle cores", "awake");
  for (const std::string& refusal : refusals_) status.mergeSummary(DiagnosticStatus::WARN, refusal);
}

void make_ros_realtime(const ros::NodeHandle& node, int priority) {
  if (priority == 0) return;
  // roscpp starts the thread of its timers with the first timer. It stays.
  node.createTimer(ros::Duration(1.0), [](const ros::TimerEvent&) {});
  make_all_threads_realtime(priority);  // If it is refused, class Realtime says so.
}

}  // namespace organ_collision
