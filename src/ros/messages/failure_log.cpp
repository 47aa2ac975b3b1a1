#include "failure_log.hpp"

#include <organ_collision/ContactArray.h>
#include <ros/console.h>

#include "text.hpp"

namespace organ_collision {

std::string reason_of(std::uint8_t status) {
  switch (status) {
    case ContactArray::OK:
      return "ok";
    case ContactArray::NO_MESH:
      return "no mesh";
    case ContactArray::NO_TRANSFORM:
      return "no transform";
    case ContactArray::STALE_MESH:
      return "stale mesh";
    case ContactArray::UNKNOWN_ORGAN:
      return "unknown organ";
    case ContactArray::UNKNOWN_TOOL:
      return "unknown tool";
    case ContactArray::PICKER_FAILED:
      return "picker failed";
    case ContactArray::INVALID_TOOL:
      return "invalid tool";
    default:
      return "invalid request";
  }
}

void check_name(const std::string& what, const std::string& name) {
  const std::string fault = name_fault(name);
  if (fault.empty()) return;
  throw Rejection(ContactArray::INVALID_REQUEST, "illegal name", what + " " + fault);
}

namespace {

constexpr std::chrono::seconds kLogPeriod(1);

}  // namespace

void FailureLog::add(const std::string& reason, const std::string& message, Time now,
                     std::uint64_t times) {
  // Without the lock, because the log may take long, and the other threads need the lock.
  const std::string line = count(reason, plain_text(message, kLongestMessage), now, times);
  if (!line.empty()) ROS_WARN("%s", line.c_str());
}

std::string FailureLog::count(const std::string& reason, const std::string& message, Time now,
                              std::uint64_t times) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Entry& entry = entries_[reason];
  const bool is_first = entry.count == 0;
  entry.count += times;
  entry.not_yet_reported += times;
  entry.latest = message;
  if (!is_first && now - entry.logged < kLogPeriod) return "";
  entry.logged = now;
  if (entry.count == 1) return message;
  return message + " (" + std::to_string(entry.count) + " times)";
}

FailureLog::Entries FailureLog::by_reason() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return entries_;
}

FailureLog::Entries FailureLog::take_report() {
  const std::lock_guard<std::mutex> lock(mutex_);
  Entries report = entries_;
  for (auto& [reason, entry] : entries_) entry.not_yet_reported = 0;
  return report;
}

void show_failures(const std::string& what, FailureLog& log,
                   diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  for (const auto& [reason, entry] : log.take_report()) {
    std::string key = what;
    key.append(", ").append(reason);
    status.add(key, entry.count);
    if (entry.not_yet_reported == 0) continue;
    const bool broken = reason == reason_of(ContactArray::PICKER_FAILED);
    status.mergeSummary(broken ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN, entry.latest);
  }
}

}  // namespace organ_collision
