#pragma once

#include <organ_collision/QueryCollisionBatch.h>

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "query/workers/worker_threads.hpp"
#include "query_snapshot.hpp"
#include "ros/steps/contact_query.hpp"

namespace organ_collision {

/// A batch after all checks that concern it as a whole. What it refers to must outlive it.
struct CheckedBatch {
  const QueryCollisionBatch::Request& request;
  std::size_t motions;  ///< their number
  const QuerySnapshot& snapshot;
  const CollisionRequest& collision;  ///< without the motion
  const ContactArray& unanswered;     ///< what all answers have in common
  std::size_t most_bytes;             ///< of all answers, serialized
};

/// Threads that answer batches together. They use only what other threads leave of the processors
/// (SCHED_IDLE), because all steps come first.
class BatchWorkers {
 public:
  /// `threads`: how many; 0: one for each processor. They start with the first batch.
  BatchWorkers(PickerKind picker, int threads);

  /// Answers the motions, in their order, whatever the number of threads. The answers end with the
  /// first motion that touches if the request asks for that. A motion that is illegal has an answer
  /// that says so. Throws Rejection if the answers have too many bytes, and other exceptions such
  /// as GlError, std::bad_alloc, and std::runtime_error after end().
  std::vector<ContactArray> answer(const CheckedBatch& batch);

  /// For any thread: the present batch and all later ones end soon, with an exception.
  void end() { ended_ = true; }

 private:
  void prepare(std::size_t worker);

  const PickerKind picker_;
  const std::size_t threads_;
  std::atomic<bool> ended_{false};
  std::vector<std::unique_ptr<ContactQuery>> queries_;  ///< by worker
  WorkerThreads workers_;  ///< the last member: its threads use the others
};

}  // namespace organ_collision
