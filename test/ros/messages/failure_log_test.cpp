#include "ros/messages/failure_log.hpp"

#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>

#include <cstdint>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "ros/messages/text.hpp"

using namespace organ_collision;

TEST(Rejection, KeepsWhatItWasMadeOf) {
  const Rejection rejection(4, "wrong size", "7 numbers; must be a multiple of 3");
  EXPECT_EQ(rejection.status(), 4);
  EXPECT_EQ(rejection.reason(), "wrong size");
  EXPECT_STREQ(rejection.what(), "7 numbers; must be a multiple of 3");
}

TEST(Rejection, EachStatusHasItsOwnReason) {
  std::set<std::string> reasons;
  for (std::uint8_t status = 0; status <= ContactArray::INVALID_TOOL; ++status) {
    reasons.insert(reason_of(status));
  }
  EXPECT_EQ(reasons.size(), ContactArray::INVALID_TOOL + 1u);
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

using namespace organ_collision;

TEST(FailureLog, CountsByReason) {
  FailureLog log;
  const FailureLog::Time now{std::chrono::hours(3)};
  log.add("wrong size", "7 numbers", now);
  log.add("wrong size", "8 numbers", now);
  log.add("not finite", "vertex 3", now);
  ASSERT_EQ(log.by_reason().size(), 2u);
  EXPECT_EQ(log.by_reason().at("wrong size").count, 2u);
  EXPECT_EQ(log.by_reason().at("wrong size").latest, "8 numbers");
  EXPECT_EQ(log.by_reason().at("not finite").not_yet_reported, 1u);
}

TEST(FailureLog, CountsSeveralFailuresAtOnce) {
  FailureLog log;
  const FailureLog::Time now{std::chrono::hours(3)};
  log.add("invalid request", "radius", now, 7);
  EXPECT_EQ(log.by_reason().at("invalid request").logged, now);
  log.add("invalid request", "radius", now + std::chrono::milliseconds(1), 3);
  EXPECT_EQ(log.by_reason().at("invalid request").count, 10u);
  EXPECT_EQ(log.by_reason().at("invalid request").not_yet_reported, 10u);
  EXPECT_EQ(log.by_reason().at("invalid request").logged, now);
}

TEST(FailureLog, MessagesArePlainAndShort) {
  FailureLog log;
  log.add("wrong size", "a\n" + std::string(10'000'000, 'x'), {});
  const std::string latest = log.by_reason().at("wrong size").latest;
  EXPECT_LE(latest.size(), kLongestMessage);
  EXPECT_EQ(latest.rfind("a xxx", 0), 0u) << latest;
}

TEST(FailureLog, ReportedOnce) {
  FailureLog log;
  log.add("wrong size", "7 numbers", {});
  EXPECT_EQ(log.take_report().at("wrong size").not_yet_reported, 1u);
  EXPECT_EQ(log.by_reason().at("wrong size").count, 1u);
  EXPECT_EQ(log.by_reason().at("wrong size").not_yet_reported, 0u);
  log.add("wrong size", "8 numbers", {});
  EXPECT_EQ(log.by_reason().at("wrong size").not_yet_reported, 1u);
}

TEST(FailureLog, LogsEachReasonOnceASecond) {
  FailureLog log;
  const FailureLog::Time start{std::chrono::hours(3)};
  log.add("wrong size", "a", start);
  log.add("wrong size", "b", start + std::chrono::milliseconds(999));
  EXPECT_EQ(log.by_reason().at("wrong size").logged, start);
  const FailureLog::Time later = start + std::chrono::milliseconds(1000);
  log.add("wrong size", "c", later);
  EXPECT_EQ(log.by_reason().at("wrong size").logged, later);
}

TEST(FailureLog, CountsAndReportsEachFailureOnceFromAllThreads) {
  FailureLog log;
  constexpr std::uint64_t kEach = 2000;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 3; ++thread) {
    threads.emplace_back([&] {
      for (std::uint64_t i = 0; i < kEach; ++i) log.add("wrong size", "7 numbers", {});
    });
  }
  std::uint64_t reported = 0;
  const auto report = [&] {
    for (const auto& [reason, entry] : log.take_report()) reported += entry.not_yet_reported;
  };
  for (int i = 0; i < 1000; ++i) report();
  for (std::thread& thread : threads) thread.join();
  report();
  EXPECT_EQ(reported, 3 * kEach);
}

TEST(FailureLog, IsShownWithItsCountsAndWarnsOfNewFailuresOnce) {
  using diagnostic_msgs::DiagnosticStatus;
  FailureLog log;
  log.add("wrong size", "7 numbers", {});
  log.add("wrong size", "8 numbers", {});
  diagnostic_updater::DiagnosticStatusWrapper status, later;
  show_failures("rejected", log, status);
  ASSERT_EQ(status.values.size(), 1u);
  EXPECT_EQ(status.values[0].key, "rejected, wrong size");
  EXPECT_EQ(status.values[0].value, "2");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "8 numbers");
  show_failures("rejected", log, later);
  EXPECT_EQ(later.values[0].value, "2");
  EXPECT_EQ(later.level, DiagnosticStatus::OK);
}

TEST(FailureLog, AFailedPickerIsAnError) {
  FailureLog log;
  log.add("picker failed", "out of memory", {});
  diagnostic_updater::DiagnosticStatusWrapper status;
  show_failures("unanswered", log, status);
  EXPECT_EQ(status.level, diagnostic_msgs::DiagnosticStatus::ERROR);
}
