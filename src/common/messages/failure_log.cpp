#include "failure_log.hpp"

#include <organ_collision/ContactArray.h>
#include <ros/console.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <sstream>

#include "text.hpp"

namespace organ_collision {

namespace {

constexpr std::chrono::seconds kLogPeriod(1);

/// The names stand in the text of ContactArray.msg in the order of their numbers, above the modes.
std::vector<std::string> read_status_names() {
  const std::string type = "uint8 ", modes = "# Modes";
  std::istringstream message(ros::message_traits::definition<ContactArray>());
  std::vector<std::string> names;
  for (std::string line; std::getline(message, line) && line.rfind(modes, 0) != 0;) {
    if (line.rfind(type, 0) != 0) continue;
    names.push_back(line.substr(type.size(), line.find('=') - type.size()));
  }
  return names;
}

}  // namespace

const std::vector<std::string>& status_names() {
  static const std::vector<std::string> names = read_status_names();
  return names;
}

std::string reason_of(std::uint8_t status) {
  if (status >= status_names().size()) return "status " + std::to_string(status);
  std::string reason = boost::algorithm::to_lower_copy(status_names()[status]);
  std::replace(reason.begin(), reason.end(), '_', ' ');
  return reason;
}

void check_name(const std::string& what, const std::string& name) {
  const std::string fault = name_fault(name);
  if (fault.empty()) return;
  throw Rejection(ContactArray::INVALID_REQUEST, "illegal name", what + " " + fault);
}

void FailureLog::add(const std::string& reason, const std::string& message, Time now) {
  const std::string plain = plain_text(message, kLongestMessage);
  std::uint64_t count = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Entry& entry = entries_[reason];
    const bool is_recent = entry.count > 0 && now - entry.logged < kLogPeriod;
    count = ++entry.count;
    ++entry.not_yet_reported;
    entry.latest = plain;
    if (is_recent) return;
    entry.logged = now;
  }
  // Logs without the lock, because logging may take long, and other threads need the lock.
  const std::string counted = count == 1 ? "" : " (" + std::to_string(count) + " times)";
  ROS_WARN("%s%s", plain.c_str(), counted.c_str());
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
