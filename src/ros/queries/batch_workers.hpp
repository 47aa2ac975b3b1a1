#pragma once

#include <organ_collision/QueryCollisionBatch.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "organ_collision/picking/picker_settings.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "query/worker_threads.hpp"
#include "query_snapshot.hpp"
#include "ros/publishing/counters.hpp"
#include "ros/steps/contact_array.hpp"

namespace organ_collision {

/// Bounds the memory of a batch whose blocks of motions several threads answer at the same time,
/// and whose answers are taken in order. Above the bound, only the block that is taken next goes
/// on, and only until the answers that were taken exceed the bound with its own. All answers then
/// exceed it by at most one answer for each thread and one block.
class AnswerBudget {
 public:
  explicit AnswerBudget(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Call it before each motion. Waits until the block may go on. Returns false if the batch has
  /// ended, or if it exceeds the bound with this block; the block then stops.
  /// `block_bytes`: of the block's answers so far.
  bool wait(std::size_t block, std::size_t block_bytes);
  /// Notes that a motion has an answer with that many bytes.
  void add(std::size_t bytes) { bytes_ += bytes; }
  /// Notes that the answers of this block are taken. All that were taken have so many bytes. The
  /// next block may then go on.
  void set_taken(std::size_t block, std::size_t taken_bytes);
  /// Ends the batch.
  void end();

 private:
  const std::size_t most_bytes_;
  std::atomic<std::size_t> bytes_{0};
  std::atomic<bool> ended_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_.
  std::size_t next_ = 0;  ///< the block that is taken next
  std::size_t taken_bytes_ = 0;
};

/// A batch after all checks that concern it as a whole. What it refers to must outlive it.
struct CheckedBatch {
  const QueryCollisionBatch::Request& request;
  std::size_t motions;  ///< their number
  const QuerySnapshot& snapshot;
  const CollisionRequest& collision;  ///< without the motion
  const ContactArray& unanswered;     ///< what all answers have in common
  std::size_t most_bytes;             ///< of all answers, serialized
};

/// The answers to one batch, while they are made. Several threads evaluate blocks of motions at the
/// same time, and one thread takes the blocks in their order. What it takes does not depend on the
/// number of threads.
class BatchAnswers {
 public:
  /// Both must outlive this. After `ended` becomes true, blocks are not evaluated to their end, and
  /// none can be taken.
  BatchAnswers(const CheckedBatch& batch, const std::atomic<bool>& ended);

  /// The number of blocks.
  std::size_t blocks() const { return blocks_.size(); }

  /// Evaluates one block. Any thread may call it, each with a query of its own. If it throws, no
  /// other block waits any more.
  void evaluate(std::size_t block, ContactQuery& query);
  /// Takes the answers of a block that was evaluated. Call it in the order of the blocks, in one
  /// thread. Returns how many answers the block had. Throws Rejection if the answers so far have
  /// too many bytes, and std::runtime_error after `ended` became true.
  std::size_t take(std::size_t block);
  /// What was taken: one answer for each motion, up to the first that touches if the request asks
  /// for that.
  std::vector<ContactArray> all() { return std::move(answers_); }

 private:
  void evaluate_motions(std::size_t block, ContactQuery& query);
  void evaluate_motion(std::size_t motion, ContactQuery& query, CollisionRequest& collision,
                       ContactArray& answer) const;
  void set_last(std::size_t motion);
  void take_answers(std::size_t block);
  void check_bytes() const;

  const CheckedBatch& batch_;
  const std::atomic<bool>& ended_;
  std::vector<std::vector<ContactArray>> blocks_;
  AnswerBudget budget_;
  /// The last motion that needs an answer. While blocks before it are evaluated, an earlier motion
  /// may still lower it.
  std::atomic<std::size_t> last_;
  std::vector<ContactArray> answers_;
  std::size_t bytes_;  ///< of the response with `answers_`, serialized
};

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
