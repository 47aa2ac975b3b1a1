#include "common/messages/failure_log.hpp"

#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>

#include <string>
#include <thread>
#include <vector>

#include "common/messages/text.hpp"

namespace organ_collision {
namespace {

using namespace std::chrono_literals;

TEST(Rejection, TheReasonOfAStatusIsItsName) {
  ASSERT_EQ(status_names().size(), 9U);
  EXPECT_EQ(status_names()[ContactArray::STALE_MESH], "STALE_MESH");
  const std::pair<std::uint8_t, std::string> reasons[] = {
      {ContactArray::OK, "ok"},
      {ContactArray::NO_MESH, "no mesh"},
      {ContactArray::PICKER_FAILED, "picker failed"},
      {ContactArray::INVALID_TOOL, "invalid tool"},
      {status_names().size(), "status 9"}};
  for (const auto& [status, reason] : reasons) EXPECT_EQ(reason_of(status), reason);
}

TEST(Rejection, IllegalNames) {
  check_name("organ", "liver");
  check_name("organ", "");
  try {
    check_name("organ", "li\nver");
    ADD_FAILURE();
  } catch (const Rejection& rejection) {
    EXPECT_EQ(rejection.status(), ContactArray::INVALID_REQUEST);
    EXPECT_EQ(rejection.reason(), "illegal name");
    EXPECT_EQ(std::string(rejection.what()).rfind("organ 'li ver' has control characters", 0), 0U)
        << rejection.what();
  }
}

class FailureLogTest : public testing::Test {
 protected:
  const FailureLog::Entry& entry() {
    entries_ = log_.by_reason();
    return entries_.at("wrong size");
  }

  const FailureLog::Time start_{3h};
  FailureLog log_;
  FailureLog::Entries entries_;
};

TEST_F(FailureLogTest, CountsAndReportsEachFailureOnceFromAllThreads) {
  constexpr std::uint64_t kEach = 2000;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 3; ++thread) {
    threads.emplace_back([&] {
      for (std::uint64_t i = 0; i < kEach; ++i) log_.add("wrong size", "7 numbers", {});
    });
  }
  std::uint64_t reported = 0;
  const auto report = [&] {
    for (const auto& [reason, entry] : log_.take_report()) reported += entry.not_yet_reported;
  };
  for (int i = 0; i < 1000; ++i) report();
  for (std::thread& thread : threads) thread.join();
  report();
  EXPECT_EQ(reported, 3 * kEach);
}

TEST_F(FailureLogTest, IsShownWithItsCountsAndWarnsOfNewFailuresOnce) {
  using diagnostic_msgs::DiagnosticStatus;
  log_.add("wrong size", "7 numbers", {});
  log_.add("wrong size", "8 numbers", {});
  diagnostic_updater::DiagnosticStatusWrapper status, later, broken;
  show_failures("rejected", log_, status);
  ASSERT_EQ(status.values.size(), 1u);
  EXPECT_EQ(status.values[0].key, "rejected, wrong size");
  EXPECT_EQ(status.values[0].value, "2");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "8 numbers");
  show_failures("rejected", log_, later);
  EXPECT_EQ(later.values[0].value, "2");
  EXPECT_EQ(later.level, DiagnosticStatus::OK);
  log_.add("picker failed", "out of memory", {});
  show_failures("unanswered", log_, broken);
  EXPECT_EQ(broken.level, DiagnosticStatus::ERROR);
}

}  // namespace
}  // namespace organ_collision
