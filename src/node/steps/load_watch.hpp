#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "step.hpp"

namespace organ_collision {

/// Notices when the steps of a node take so long that it falls behind its inputs: the poses, ticks
/// and shapes for which steps are due. Their answers are right, but late.
class LoadWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// The watch looks at what happened in periods of at least this length.
  static constexpr std::chrono::seconds kPeriod{1};

  /// Notes a step that was answered.
  void add(const ToolStep& step);
  /// Notes the end of a round. A round without steps does not count. `merged`: how many inputs,
  /// since the start, shared a step with a later one.
  void add_round(Time begin, Time end, std::uint64_t merged);

  /// Whether the node fell behind in the last period: steps took most of the time, and most inputs
  /// shared a step with a later one.
  bool is_behind(Time now) const { return is_behind_ && now - period_.begin < 2 * kPeriod; }
  /// If a period in which the node fell behind has ended since the last call: what was slow.
  std::optional<std::string> take_report();

 private:
  /// What happened in one period.
  struct Period {
    Time begin;
    double busy_sec = 0.0;
    std::uint64_t rounds = 0, merged = 0;
    double slowest_sec = 0.0;  ///< the longest query
    std::string slowest = {};  ///< the tool and the organ of that query, and what was asked
  };

  Period period_;
  bool has_steps_ = false;    ///< whether the present round has steps
  std::uint64_t merged_ = 0;  ///< inputs that were merged before the present period
  bool is_behind_ = false;
  std::optional<std::string> report_;
};

}  // namespace organ_collision
