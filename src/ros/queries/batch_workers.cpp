#include "batch_workers.hpp"

#include "ros/interface/thread_scheduling.hpp"

namespace organ_collision {

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
