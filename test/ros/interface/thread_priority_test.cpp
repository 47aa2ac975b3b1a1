#include "ros/interface/thread_priority.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

namespace organ_collision {
namespace {

int niceness() { return getpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid))); }

TEST(ThreadPriority, IsLoweredForTheCallingThreadAlone) {
  const int before = niceness();
  int lowered = before;
  std::thread([&] {
    lower_priority_of_this_thread();
    lowered = niceness();
  }).join();
  EXPECT_EQ(lowered, std::max(before, 10));
  EXPECT_EQ(niceness(), before);
}

TEST(ThreadPriority, YieldsToAllThreadsInTheCallingThreadAlone) {
  int policy = -1;
  std::thread([&] {
    yield_to_all_threads();
    policy = sched_getscheduler(0);
  }).join();
  EXPECT_EQ(policy, SCHED_IDLE);
  EXPECT_NE(sched_getscheduler(0), SCHED_IDLE);
}

}  // namespace
}  // namespace organ_collision
