#include "ros/interface/memory_lock.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "test/resident_memory.hpp"

namespace organ_collision {
namespace {

constexpr uid_t kNobody = 65534;
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

}  // namespace
}  // namespace organ_collision
