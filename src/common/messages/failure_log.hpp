#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace organ_collision {

/// A message or request that was refused. what() names the illegal value and what is legal.
class Rejection : public std::runtime_error {
 public:
  /// `status` is one of the statuses of ContactArray. `reason` is a short text that is the same for
  /// all refusals of one kind: refusals are counted by it.
  Rejection(std::uint8_t status, std::string reason, const std::string& message)
      : std::runtime_error(message), status_(status), reason_(std::move(reason)) {}

  std::uint8_t status() const { return status_; }
  const std::string& reason() const { return reason_; }

 private:
  std::uint8_t status_;
  std::string reason_;
};

/// The names of the statuses of ContactArray, at the index of their numbers: "OK", "NO_MESH", ...
const std::vector<std::string>& status_names();

/// The reason under which failures with this status of ContactArray are counted: its name in small
/// letters, for example "no mesh".
std::string reason_of(std::uint8_t status);

/// Throws Rejection, with the message "WHAT 'NAME' ...", if `name` is not legal (name_fault()).
/// `what`: the thing that has the name, for example "organ". An empty name is accepted.
void check_name(const std::string& what, const std::string& name);

/// Counts failures by reason. For each reason, it logs at most one failure a second (steady clock).
/// Any thread may use a FailureLog at any time.
class FailureLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Entry {
    std::uint64_t count = 0;
    std::uint64_t not_yet_reported = 0;  ///< failures since the last call of take_report()
    std::string latest;                  ///< plain text of the last message
    Time logged;                         ///< when a failure with this reason was last logged
  };

  /// `reason`: one of a few fixed texts, under which failures are counted. `message`: what was
  /// wrong, with the illegal value. The user reads the message without the reason.
  void add(const std::string& reason, const std::string& message,
           Time now = std::chrono::steady_clock::now());

  using Entries = std::map<std::string, Entry>;
  Entries by_reason() const;
  /// Returns all entries for a report to the user, and then counts their failures as reported.
  Entries take_report();

 private:
  mutable std::mutex mutex_;
  Entries entries_;  ///< guarded by mutex_
};

/// Adds the count of each reason to `status`, with the key "WHAT, REASON". If a reason has failures
/// that are not yet reported, its latest message becomes a warning, or an error if the picker
/// failed.
void show_failures(const std::string& what, FailureLog& log,
                   diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace organ_collision
