#pragma once

#include <organ_collision/QueryCollisionBatch.h>

#include <atomic>
#include <cstddef>
#include <optional>
#include <vector>

#include "organ_collision/picking/picker_settings.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "query/worker_threads.hpp"
#include "query_snapshot.hpp"
#include "ros/publishing/counters.hpp"
#include "ros/steps/contact_array.hpp"

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

/// Threads that answer batches together with the thread that calls answer(). They have the lowest
/// ordinary priority, because all steps come first.
class BatchWorkers {
 public:
  /// `threads`: how many, with the calling one; 0: one for each processor. `statistics` counts the
  /// motions and must outlive this.
  BatchWorkers(const PickerSettings& picker, int threads, ServiceStatistics& statistics)
      : picker_(picker), threads_(threads), statistics_(statistics) {}

  /// Makes the GL context of the thread that calls answer(), which else does it itself.
  void start();
  /// Answers the motions, in their order, whatever the number of threads. The answers end with the
  /// first motion that touches if the request asks for that. A motion that is illegal has an answer
  /// that says so. Throws Rejection if the answers have too many bytes, and other exceptions such
  /// as GlError, and std::runtime_error after end(). While they are made, the answers exceed the
  /// legal number of bytes by at most one answer for each thread.
  std::vector<ContactArray> answer(const CheckedBatch& batch);

  /// For any thread: the present batch and all later ones end soon, with an exception.
  void end() { ended_ = true; }

 private:
  const PickerSettings picker_;
  const int threads_;
  ServiceStatistics& statistics_;
  std::atomic<bool> ended_{false};
  std::optional<QueryThreads<ContactQuery>> workers_;  ///< from the first batch on
};

}  // namespace organ_collision
