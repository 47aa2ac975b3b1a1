#pragma once

#include <organ_collision/QueryCollisionBatch.h>

#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

#include "answer_budget.hpp"
#include "organ_collision/query/collision_query.hpp"
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

}  // namespace organ_collision
