#include "ros/node/scheduling.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "test/resident_memory.hpp"

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

constexpr std::size_t kMore = 10'000'000;  // [bytes]

/// Locks the memory of this process, takes more, and ends the process. Exit status 0: the functions
/// told what happened.
void lock_and_take_more() {
  const std::string refusal = lock_memory();
  const long long locked = locked_memory();
  const std::vector<char> more(kMore, 'x');
  const bool has_grown = locked_memory() >= locked + static_cast<long long>(kMore);
  const bool is_locked = locked > 0 && has_grown;
  const bool is_as_before = locked == 0 && locked_memory() == 0;
  _exit((refusal.empty() ? is_locked : is_as_before) ? 0 : 1);
}

/// Locks the memory of this process, reserves much more, and ends the process. Exit status 0: what
/// is not used takes no RAM. A peer makes roscpp reserve a gigabyte with four bytes.
void lock_and_reserve_more() {
  constexpr std::size_t kMuch = 500'000'000;  // [bytes]
  lock_memory();
  const long before = resident_memory();
  volatile char* const reserved = new char[kMuch];
  reserved[kMuch / 2] = 'x';
  _exit(resident_memory() - before < static_cast<long>(kMuch / 10) ? 0 : 1);
}

/// Locks memory without the right to lock memory beyond `limit` bytes. The system must refuse.
void lock_without_rights(rlim_t limit) {
  const rlimit limits{limit, limit};
  setrlimit(RLIMIT_MEMLOCK, &limits);
  if (getuid() == 0 && setuid(kNobody) != 0) _exit(2);
  const std::string refusal = lock_memory();
  const std::string reason = "locked memory is limited to " + std::to_string(limit / 1024) + " kB";
  _exit(refusal == reason && locked_memory() == 0 ? 0 : 1);
}

TEST(MemoryLock, HoldsAlsoWhatIsTakenLaterUnlessTheSystemRefuses) {
  EXPECT_EXIT(lock_and_take_more(), testing::ExitedWithCode(0), "");
}

TEST(MemoryLock, WhatIsReservedAndNotUsedTakesNoMemory) {
  EXPECT_EXIT(lock_and_reserve_more(), testing::ExitedWithCode(0), "");
}

TEST(MemoryLock, ALimitIsARefusal) {
  EXPECT_EXIT(lock_without_rights(0), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(lock_without_rights(8'192 * 1024), testing::ExitedWithCode(0), "");
}

constexpr char kDevice[] = "/dev/cpu_dma_latency";

/// How often this process has the device open.
int requests() {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code has_closed;
    count += std::filesystem::read_symlink(entry.path(), has_closed) == kDevice ? 1 : 0;
  }
  return count;
}

/// [us] The shortest of all requests of the system. Negative: it may not be read.
std::int32_t shortest_request() {
  std::int32_t latency = -1;
  const int device = open(kDevice, O_RDWR);
  if (device < 0 || read(device, &latency, sizeof latency) != sizeof latency) latency = -1;
  if (device >= 0) close(device);
  return latency;
}

/// Exit status 0: without the right to open the device, the refusal tells it.
void ask_without_rights() {
  if (getuid() == 0 && setuid(kNobody) != 0) _exit(2);
  const bool is_permitted = shortest_request() >= 0;
  const AwakeCores cores;
  _exit(cores.refusal().empty() == is_permitted ? 0 : 1);
}

TEST(AwakeCores, TheRequestHoldsAsLongAsTheObjectUnlessTheSystemRefuses) {
  const bool is_permitted = shortest_request() >= 0;
  {
    const AwakeCores cores;
    EXPECT_EQ(cores.refusal().empty(), is_permitted) << cores.refusal();
    EXPECT_EQ(requests(), is_permitted ? 1 : 0);
    EXPECT_EQ(shortest_request(), is_permitted ? 0 : -1);
  }
  EXPECT_EQ(requests(), 0);
}

TEST(AwakeCores, WithoutTheRightTheRefusalSaysWhy) {
  EXPECT_EXIT(ask_without_rights(), testing::ExitedWithCode(0), "");
}

}  // namespace

}  // namespace organ_collision
