#include "failure_log.hpp"

#include <organ_collision/ContactArray.h>
#include <ros/console.h>

#include "plain_text.hpp"
#include "rejection.hpp"

namespace organ_collision {
namespace {

constexpr std::chrono::seconds kLogPeriod(1);

}  // namespace

void FailureLog::add(const std::string& reason, const std::string& message, Time now) {
  Entry& entry = entries_[reason];
  ++entry.count;
  ++entry.not_yet_reported;
  entry.latest = plain_text(message, kLongestMessage);
  if (entry.count > 1 && now - entry.logged < kLogPeriod) return;
  entry.logged = now;
  const std::string times = entry.count > 1 ? " (" + std::to_string(entry.count) + " times)" : "";
  ROS_WARN("%s%s", entry.latest.c_str(), times.c_str());
}

void FailureLog::reported() {
  for (auto& [reason, entry] : entries_) entry.not_yet_reported = 0;
}

void show_failures(const std::string& what, FailureLog& log,
                   diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  for (const auto& [reason, entry] : log.by_reason()) {
    std::string key = what;
    key.append(", ").append(reason);
    status.add(key, entry.count);
    if (entry.not_yet_reported == 0) continue;
    const bool broken = reason == reason_of(ContactArray::PICKER_FAILED);
    status.mergeSummary(broken ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN, entry.latest);
  }
  log.reported();
}

}  // namespace organ_collision
