#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

namespace organ_collision {

/// Counts failures by reason. Logs each reason at most once a second of the steady clock.
class FailureLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Entry {
    std::uint64_t count = 0;
    std::uint64_t not_yet_reported = 0;  ///< failures since the last call of reported()
    std::string latest;                  ///< message, plain text of at most kLongestMessage bytes
    Time logged;                         ///< when a failure with this reason was last logged
  };

  /// `reason`: one of a few fixed texts, under which failures are counted. `message`: what was
  /// wrong, with the illegal value. The user reads the message without the reason.
  void add(const std::string& reason, const std::string& message, Time now);

  const std::map<std::string, Entry>& by_reason() const { return entries_; }
  /// Notes that all entries have been shown to the user.
  void reported();

 private:
  std::map<std::string, Entry> entries_;
};

/// Adds the count of each reason to `status`, with the key "WHAT, REASON". If failures were added
/// since the last call, their latest message becomes a warning, or an error if the picker failed.
void show_failures(const std::string& what, FailureLog& log,
                   diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace organ_collision
