#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

namespace organ_collision {

/// Counts failures by reason and logs each reason at most once a second of steady time.
class FailureLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Entry {
    std::uint64_t count = 0;
    std::uint64_t not_yet_reported = 0;  ///< since the last call of reported()
    std::string latest;                  ///< message, plain and at most kLongestMessage bytes
    Time logged;
  };

  /// `reason`: one of a small set; `message`: what was wrong, with the value.
  void add(const std::string& reason, const std::string& message, Time now);

  const std::map<std::string, Entry>& by_reason() const { return entries_; }
  /// Whoever shows the entries has shown them.
  void reported();

 private:
  std::map<std::string, Entry> entries_;
};

}  // namespace organ_collision
