#include "offline/progress.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace organ_collision {
namespace {

std::string reported(std::optional<std::size_t> total) {
  Progress progress(total);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  testing::internal::CaptureStderr();
  progress.report(3);
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, is_told_with_the_total_if_that_is_known) {
  EXPECT_EQ(reported(7), "query_offline: 3 of 7 motions\n");
  EXPECT_EQ(reported(std::nullopt), "query_offline: 3 motions\n");
}

}  // namespace
}  // namespace organ_collision
