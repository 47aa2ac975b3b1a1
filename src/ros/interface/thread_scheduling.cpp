#include "thread_scheduling.hpp"

#include <sched.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

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

}  // namespace organ_collision
