#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>

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

}  // namespace organ_collision
