#include "batch_workers.hpp"

#include <ros/serialization.h>

#include <memory>
#include <stdexcept>

#include "query_request.hpp"
#include "ros/threads/realtime.hpp"

namespace organ_collision {
namespace {

void answer_motion(const CheckedBatch& batch, std::size_t motion, ContactQuery& query,
                   ContactArray& answer) {
  const QueryCollisionBatch::Request& request = batch.request;
  const GivenMotion given{request.motions.empty() ? nullptr : &request.motions[motion],
                          request.link_motions.empty() ? nullptr : &request.link_motions[motion]};
  CollisionRequest collision = batch.collision;
  try {
    set_motion(given, batch.snapshot, collision);
    query.evaluate(collision, answer);
  } catch (const Rejection& rejection) {
    set_failure(answer, rejection.status(), rejection.what());
  }
}

/// Whether no motion after this one is to be answered.
bool is_last(const CheckedBatch& batch, const ContactArray& answer) {
  return batch.request.stop_at_first_contact && !answer.contacts.empty();
}

}  // namespace

void BatchWorkers::start() {
  // Each thread lowers its priority only when its GL context is made, because that holds locks for
  // long that the node's thread may want, too.
  if (!workers_) workers_.emplace(thread_count(threads_), picker_, yield_to_all_threads);
}

std::vector<ContactArray> BatchWorkers::answer(const CheckedBatch& batch) {
  using ros::serialization::serializationLength;
  start();
  std::vector<std::unique_ptr<ContactArray>> made(batch.motions);
  std::atomic<std::size_t> bytes_made{0};
  const auto evaluate = [&](std::size_t worker, std::size_t motion) {
    if (ended_) throw std::runtime_error("the node is about to end");
    made[motion] = std::make_unique<ContactArray>(batch.unanswered);
    answer_motion(batch, motion, workers_->query(worker), *made[motion]);
    bytes_made += serializationLength(*made[motion]);
    if (is_last(batch, *made[motion]) || bytes_made > batch.most_bytes) workers_->skip_rest();
  };

  std::vector<ContactArray> answers;
  answers.reserve(batch.motions);
  std::size_t bytes = serializationLength(QueryCollisionBatch::Response());
  const auto take = [&](std::size_t motion) {
    if (!answers.empty() && is_last(batch, answers.back())) return;
    answers.push_back(std::move(*made[motion]));
    made[motion].reset();
    bytes += serializationLength(answers.back());
    if (bytes > batch.most_bytes) {
      refuse("the answers to the first ", answers.size(), " of ", batch.motions, " motions have ",
             bytes, " bytes; a batch's must have at most ", batch.most_bytes,
             " (max_batch_bytes): ask for fewer motions at once");
    }
    statistics_.add_motion();
  };
  workers_->run(batch.motions, evaluate, take);
  statistics_.add_batch();
  return answers;
}

}  // namespace organ_collision
