#include "common/threads/realtime.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "test/resident_memory.hpp"

namespace organ_collision {
namespace {

// The system may grant or refuse each request. test/rostest/start_test.py compares what the
// nodes say of all their threads and locked memory with what the system says.

constexpr int kPriority = 7;

int thread_niceness() { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); }

bool is_realtime(pid_t thread) {
  sched_param parameters{};
  sched_getparam(thread, &parameters);
  return sched_getscheduler(thread) == (SCHED_FIFO | SCHED_RESET_ON_FORK) &&
         parameters.sched_priority == kPriority;
}

/// What /diagnostics says of the calling thread, after a node has asked the system for this.
std::string said(const RealtimeParameters& asked) {
  diagnostic_updater::DiagnosticStatusWrapper status;
  Realtime(asked).diagnose(status);
  return status.message;
}

/// Runs `is_right` in a process of its own, without rights if `limit` says so.
template <typename IsRight>
void expect_in_process(const IsRight& is_right, std::optional<rlim_t> limit = std::nullopt) {
  constexpr uid_t kNobody = 65534;
  const auto run = [&] {
    if (limit) {
      const rlimit none{0, 0}, limits{*limit, *limit};
      setrlimit(RLIMIT_RTPRIO, &none);
      setrlimit(RLIMIT_MEMLOCK, &limits);
      if (getuid() == 0 && setuid(kNobody) != 0) _exit(2);
    }
    _exit(is_right() ? 0 : 1);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(0), "");
}

TEST(Scheduling, AThreadIsRealtimeUnlessTheSystemRefusesAndThoseThatItStartsAreOrdinary) {
  std::thread([] {
    const bool is_granted = make_this_thread_realtime(kPriority).empty();
    EXPECT_EQ(is_realtime(gettid()), is_granted);
    EXPECT_EQ(said({}), is_granted ? "SCHED_FIFO, priority 7" : "ordinary");
    std::thread([] { EXPECT_EQ(said({}), "ordinary"); }).join();
  }).join();
  EXPECT_EQ(said({}), "ordinary");
}

TEST(Scheduling, WithoutTheRightThereIsAReasonAndNothingChanges) {
  expect_in_process(
      [] {
        return said({kPriority}).rfind("realtime_priority 7 is refused: ", 0) == 0 &&
               said({}) == "ordinary";
      },
      0);
}

TEST(Scheduling, TheCallingThreadAloneLowersItsPriority) {
  const int before = thread_niceness();
  std::thread([&] {
    lower_priority_of_this_thread();
    EXPECT_EQ(thread_niceness(), std::min(before + 10, 19));
    yield_to_all_threads();
    EXPECT_EQ(thread_niceness(), 19);
  }).join();
  EXPECT_EQ(thread_niceness(), before);
}

// A sanitizer reserves terabytes.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#endif

TEST(MemoryLock, ALimitIsARefusal) {
  for (const rlim_t kilobytes : {0, 8192}) {
    const std::string reason = "lock_memory is refused: locked memory is limited to " +
                               std::to_string(kilobytes) + " kB; ";
    expect_in_process([&] { return said({0, true}).rfind(reason, 0) == 0; }, kilobytes * 1024);
  }
}

}  // namespace
}  // namespace organ_collision
