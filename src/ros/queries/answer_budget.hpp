#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace organ_collision {

/// Bounds the memory of a batch whose blocks of motions several threads answer at the same time,
/// and whose answers are taken in order. Above the bound, only the block that is taken next goes
/// on. The answers exceed the bound by at most one answer for each thread and one block.
class AnswerBudget {
 public:
  explicit AnswerBudget(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Call it before each motion. Waits until the block may go on. Returns false if the batch has
  /// ended; the block then stops.
  bool wait(std::size_t block);
  /// Notes that a motion has an answer with that many bytes.
  void add(std::size_t bytes) { bytes_ += bytes; }
  /// Notes that the answers of this block are taken. The next block may then go on.
  void set_taken(std::size_t block);
  /// Ends the batch.
  void end();

 private:
  const std::size_t most_bytes_;
  std::atomic<std::size_t> bytes_{0};
  std::atomic<bool> ended_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t next_ = 0;  ///< the block that is taken next; guarded by mutex_
};

}  // namespace organ_collision
