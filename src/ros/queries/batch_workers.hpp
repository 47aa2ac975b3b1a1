#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "batch_answers.hpp"
#include "organ_collision/picking/picker_settings.hpp"
#include "query/workers/worker_threads.hpp"
#include "ros/steps/contact_query.hpp"
#include "service_statistics.hpp"

namespace organ_collision {

/// Threads that answer batches together. They have the lowest ordinary priority, because all steps
/// come first.
class BatchWorkers {
 public:
  /// `threads`: how many; 0: one for each processor. They start with the first batch. `statistics`
  /// counts the motions and must outlive this.
  BatchWorkers(const PickerSettings& picker, int threads, ServiceStatistics& statistics);

  /// Answers the motions, in their order, whatever the number of threads. The answers end with the
  /// first motion that touches if the request asks for that. A motion that is illegal has an answer
  /// that says so. Throws Rejection if the answers have too many bytes, and other exceptions such
  /// as GlError, std::bad_alloc, and std::runtime_error after end().
  std::vector<ContactArray> answer(const CheckedBatch& batch);

  /// For any thread: the present batch and all later ones end soon, with an exception.
  void end() { ended_ = true; }

 private:
  void prepare(std::size_t worker);

  const PickerSettings picker_;
  const std::size_t threads_;
  ServiceStatistics& statistics_;
  std::atomic<bool> ended_{false};
  std::vector<std::unique_ptr<ContactQuery>> queries_;  ///< by worker
  WorkerThreads workers_;  ///< the last member: its threads use the others
};

}  // namespace organ_collision
