#include "ros/interface/thread_scheduling.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <future>
#include <thread>

namespace organ_collision {
namespace {

constexpr int kPriority = 7;
constexpr uid_t kNobody = 65534;

pid_t this_thread() { return static_cast<pid_t>(syscall(SYS_gettid)); }

int niceness() { return getpriority(PRIO_PROCESS, static_cast<id_t>(this_thread())); }

/// Priority 0 is that of ordinary threads.
int priority_of(pid_t thread) {
  sched_param parameters{};
  sched_getparam(thread, &parameters);
  return parameters.sched_priority;
}

/// What the system must report after a call that returned `refusal`.
void expect_realtime_unless(const std::string& refusal, pid_t thread) {
  EXPECT_EQ(sched_getscheduler(thread),
            refusal.empty() ? SCHED_FIFO | SCHED_RESET_ON_FORK : SCHED_OTHER);
  EXPECT_EQ(priority_of(thread), refusal.empty() ? kPriority : 0);
}

/// Calls `action` in a process without the right to SCHED_FIFO. Returns from that process.
template <typename Action>
void call_without_rights(const Action& action) {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_RTPRIO, &none);
  if (getuid() == 0 && setuid(kNobody) != 0) _exit(2);
  _exit(action() ? 0 : 1);
}

TEST(ThreadScheduling, TheThreadIsRealtimeUnlessTheSystemRefuses) {
  std::thread([] {
    const std::string refusal = make_this_thread_realtime(kPriority);
    expect_realtime_unless(refusal, this_thread());
    EXPECT_EQ(scheduling_of_this_thread(), refusal.empty() ? "SCHED_FIFO, priority 7" : "ordinary");
  }).join();
  EXPECT_EQ(scheduling_of_this_thread(), "ordinary");
}

TEST(ThreadScheduling, ThreadsThatARealtimeThreadStartsAreOrdinary) {
  std::thread([] {
    make_this_thread_realtime(kPriority);
    std::thread([] { EXPECT_EQ(scheduling_of_this_thread(), "ordinary"); }).join();
  }).join();
}

TEST(ThreadScheduling, AllThreadsOfTheProcess) {
  EXPECT_EXIT(
      {
        std::promise<pid_t> number;
        std::promise<void> end;
        std::thread other([&] {
          number.set_value(this_thread());
          end.get_future().wait();
        });
        const pid_t thread = number.get_future().get();
        const auto threads = threads_of_this_process();
        EXPECT_EQ(std::count(threads.begin(), threads.end(), thread), 1);
        EXPECT_EQ(std::count(threads.begin(), threads.end(), this_thread()), 1);
        const std::string refusal = make_all_threads_realtime(kPriority);
        expect_realtime_unless(refusal, thread);
        expect_realtime_unless(refusal, this_thread());
        end.set_value();
        other.join();
        _exit(testing::Test::HasFailure() ? 1 : 0);
      },
      testing::ExitedWithCode(0), "");
}

TEST(ThreadScheduling, WithoutTheRightThereIsAReasonAndNothingChanges) {
  EXPECT_EXIT(call_without_rights([] {
                return !make_this_thread_realtime(kPriority).empty() &&
                       !make_all_threads_realtime(kPriority).empty() &&
                       scheduling_of_this_thread() == "ordinary";
              }),
              testing::ExitedWithCode(0), "");
}

TEST(ThreadScheduling, ThePriorityIsLoweredForTheCallingThreadAlone) {
  const int before = niceness();
  int lowered = before;
  std::thread([&] {
    lower_priority_of_this_thread();
    lowered = niceness();
  }).join();
  EXPECT_EQ(lowered, std::min(before + 10, 19));
  EXPECT_EQ(niceness(), before);
}

TEST(ThreadScheduling, TheCallingThreadAloneYieldsToAllThreads) {
  const int before = niceness();
  int lowered = before;
  std::thread([&] {
    yield_to_all_threads();
    lowered = niceness();
  }).join();
  EXPECT_EQ(lowered, 19);
  EXPECT_EQ(niceness(), before);
}

}  // namespace
}  // namespace organ_collision
