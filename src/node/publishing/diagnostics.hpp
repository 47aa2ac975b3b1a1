#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "common/messages/failure_log.hpp"
#include "node/steps/collision_pipeline.hpp"
#include "node/tools/tool.hpp"

namespace diagnostic_updater {
// Its header takes a compiler 3 s.
class DiagnosticTaskVector;  // NOLINT(cppcoreguidelines-virtual-class-destructor)
}  // namespace diagnostic_updater

namespace organ_collision {

/// Counts events and gives their rate.
class EventRate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit EventRate(Time start) : since_(start) {}
  void count() { ++count_; }
  /// [1/s] The rate since the last call, or since the start. 0 if no time has passed.
  double take(Time now);

 private:
  Time since_;
  std::uint64_t count_ = 0;
};

/// Statistics of the durations of the last kCapacity events [s]. Any thread may use it at any time.
class DurationStatistics {
 public:
  static constexpr std::size_t kCapacity = 4096;

  struct Summary {
    std::size_t count = 0;  ///< number of events since the start; if it is 0, all members are 0
    double median = 0.0;
    double percentile_99 = 0.0;
    double worst = 0.0;
  };

  void add(double seconds);
  /// The percentile p is the smallest duration that at least p percent of the events do not exceed.
  Summary summary() const;

 private:
  mutable std::mutex mutex_;  ///< guards the members below
  std::array<double, kCapacity> seconds_{};
  std::size_t count_ = 0;
};

/// What the node counts for /diagnostics.
struct NodeCounters {
  EventRate meshes{std::chrono::steady_clock::now()};  ///< accepted shapes of organs
  std::uint64_t published = 0;       ///< answers on `contacts`, also those about refused messages
  DurationStatistics query_times;    ///< how long the queries of answered steps took
  DurationStatistics service_times;  ///< how long single service queries took, without waiting
  std::atomic<std::uint64_t> batches{0};  ///< batches that were answered to the end
  std::atomic<std::uint64_t> motions{0};  ///< motions that were answered, also in the present batch
  FailureLog rejected;                    ///< messages that were refused
  FailureLog doubted;                     ///< poses that are probably not in metres
  FailureLog failed;                      ///< steps without an answer
  FailureLog incomplete;                  ///< answered steps whose path is not wholly known
  FailureLog refused;                     ///< service calls, and motions of batches, that failed
};

/// The tools of a node, and what the node has received. Every node with organs shows these on
/// /diagnostics. What the references refer to must outlive the tasks.
struct ReceivedParts {
  const double& mesh_timeout_sec;  ///< 0: a mesh is never stale
  const std::vector<Tool>& tools;
  const OrganRegistry& organs;
  const OrganIntake& intake;
  EventRate& meshes;     ///< accepted shapes of organs
  FailureLog& rejected;  ///< messages that were refused
  FailureLog& doubted;   ///< poses that are probably not in metres
};

using Status = diagnostic_updater::DiagnosticStatusWrapper;

/// Shows how many durations there were, their median, 99th percentile and maximum. `count` and
/// `time` are the names that are shown, for example "queries" and "query time".
void show_times(const std::string& count, const std::string& time,
                const DurationStatistics& statistics, Status& status);

/// Adds the tasks "tools", "organs" and "messages".
void add_diagnostics(diagnostic_updater::DiagnosticTaskVector& tasks, const ReceivedParts& parts);

// What the tasks show. The last one is that of the collision node: what it has answered.
void show_tools(const ReceivedParts& parts, Status& status);
void show_organs(const ReceivedParts& parts, Status& status);
void show_messages(const ReceivedParts& parts, Status& status);
void show_queries(const std::vector<std::string>& misspelt, const CollisionPipeline& pipeline,
                  NodeCounters& counters, Status& status);

}  // namespace organ_collision
