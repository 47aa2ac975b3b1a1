#include "batch_workers.hpp"

#include <ros/serialization.h>

#include <algorithm>
#include <stdexcept>

#include "query_request.hpp"
#include "ros/node/scheduling.hpp"

namespace organ_collision {

bool AnswerBudget::wait(std::size_t block, std::size_t block_bytes) {
  if (bytes_ > most_bytes_) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return ended_ || next_ == block; });
    if (taken_bytes_ + block_bytes > most_bytes_) return false;
  }
  return !ended_;
}

void AnswerBudget::set_taken(std::size_t block, std::size_t taken_bytes) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    next_ = block + 1;
    taken_bytes_ = taken_bytes;
  }
  changed_.notify_all();
}

void AnswerBudget::end() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
}

namespace {

/// [motions] A task of a worker. Long enough that its hand-over costs little, short enough that all
/// workers end at about the same time.
constexpr std::size_t kBlock = 16;

}  // namespace

BatchAnswers::BatchAnswers(const CheckedBatch& batch, const std::atomic<bool>& ended)
    : batch_(batch),
      ended_(ended),
      blocks_((batch.motions + kBlock - 1) / kBlock),
      budget_(batch.most_bytes),
      last_(batch.motions),
      bytes_(ros::serialization::serializationLength(QueryCollisionBatch::Response())) {
  answers_.reserve(batch.motions);
}

void BatchAnswers::evaluate(std::size_t block, ContactQuery& query) {
  try {
    evaluate_motions(block, query);
  } catch (...) {
    budget_.end();
    throw;
  }
}

std::size_t BatchAnswers::take(std::size_t block) {
  const std::size_t before = answers_.size();
  try {
    take_answers(block);
  } catch (...) {
    budget_.end();
    throw;
  }
  budget_.set_taken(block, bytes_);
  return answers_.size() - before;
}

void BatchAnswers::evaluate_motions(std::size_t block, ContactQuery& query) {
  const std::size_t first = block * kBlock, end = std::min(first + kBlock, batch_.motions);
  CollisionRequest collision = batch_.collision;
  std::size_t block_bytes = 0;
  for (std::size_t motion = first; motion < end && motion <= last_; ++motion) {
    if (ended_ || !budget_.wait(block, block_bytes)) return;
    if (blocks_[block].empty()) blocks_[block].reserve(end - first);
    ContactArray& answer = blocks_[block].emplace_back(batch_.unanswered);
    evaluate_motion(motion, query, collision, answer);
    const std::size_t bytes = ros::serialization::serializationLength(answer);
    block_bytes += bytes;
    budget_.add(bytes);
    if (batch_.request.stop_at_first_contact && !answer.contacts.empty()) set_last(motion);
  }
}

void BatchAnswers::evaluate_motion(std::size_t motion, ContactQuery& query,
                                   CollisionRequest& collision, ContactArray& answer) const {
  const QueryCollisionBatch::Request& request = batch_.request;
  const GivenMotion given{request.motions.empty() ? nullptr : &request.motions[motion],
                          request.link_motions.empty() ? nullptr : &request.link_motions[motion]};
  try {
    set_motion(given, batch_.snapshot, collision);
    query.evaluate(collision, answer);
  } catch (const Rejection& rejection) {
    set_failure(answer, rejection.status(), rejection.what());
  }
}

/// No motion after this one needs an answer.
void BatchAnswers::set_last(std::size_t motion) {
  std::size_t last = last_;
  while (motion < last && !last_.compare_exchange_weak(last, motion)) {
  }
}

/// The block and all before it are evaluated, so that it is known which of their motions is the
/// last one.
void BatchAnswers::take_answers(std::size_t block) {
  if (ended_) throw std::runtime_error("the node is about to end");
  for (ContactArray& answer : blocks_[block]) {
    if (answers_.size() > last_) break;
    bytes_ += ros::serialization::serializationLength(answer);
    answers_.push_back(std::move(answer));
    check_bytes();
  }
  std::vector<ContactArray>().swap(blocks_[block]);
}

void BatchAnswers::check_bytes() const {
  if (bytes_ <= batch_.most_bytes) return;
  refuse("the answers to the first ", answers_.size(), " of ", batch_.motions, " motions have ",
         bytes_, " bytes; a batch's must have at most ", batch_.most_bytes,
         " (max_batch_bytes): ask for fewer motions at once");
}

BatchWorkers::BatchWorkers(const PickerSettings& picker, int threads, ServiceStatistics& statistics)
    : picker_(picker),
      threads_(thread_count(threads)),
      statistics_(statistics),
      queries_(threads_ + 1),
      workers_(WorkerThreads::Caller::kWaits, [this](std::size_t worker) { prepare(worker); }) {}

std::vector<ContactArray> BatchWorkers::answer(const CheckedBatch& batch) {
  workers_.start(threads_);
  BatchAnswers answers(batch, ended_);
  workers_.run(
      answers.blocks(),
      [&](std::size_t worker, std::size_t block) { answers.evaluate(block, *queries_[worker]); },
      [&](std::size_t block) { statistics_.add_motions(answers.take(block)); });
  statistics_.add_batch();
  return answers.all();
}

void BatchWorkers::prepare(std::size_t worker) {
  queries_[worker] = std::make_unique<ContactQuery>(picker_);
  // Only now: making a GL context holds locks for long that the node's thread may want, too.
  yield_to_all_threads();
}

}  // namespace organ_collision
