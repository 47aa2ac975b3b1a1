#include "step_workers.hpp"

#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <functional>

#include "ros/node/scheduling.hpp"

namespace organ_collision {

StepWorkers::StepWorkers(const NodeParameters& parameters)
    : picker_(parameters.picker),
      realtime_priority_(parameters.realtime.priority),
      queries_(thread_count(parameters.threads)),
      threads_(WorkerThreads::Caller::kWorks, [this](std::size_t worker) { prepare(worker); }) {
  queries_.front() = std::make_unique<ContactQuery>(picker_);
  // Already here, because a thread costs milliseconds if memory is locked.
  start_for(parameters.tools.size());
}

void StepWorkers::start_for(std::size_t steps) {
  if (steps > 1) threads_.start(std::min(steps, queries_.size()) - 1);
}

void StepWorkers::run(const StepEvaluator& evaluator, std::vector<DueStep>& steps,
                      const Deliver& deliver) {
  start_for(steps.size());
  const auto work = [&](std::size_t worker, std::size_t step) {
    if (!steps[step].answer) evaluator.evaluate(steps[step], *queries_[worker]);
  };
  threads_.run(steps.size(), std::ref(work), deliver);  // The reference spares an allocation.
}

void StepWorkers::prepare(std::size_t worker) {
  try {
    queries_[worker] = std::make_unique<ContactQuery>(picker_);
  } catch (const std::exception& error) {
    ROS_WARN("a thread for steps could not be started, the others do its work: %s", error.what());
    throw;
  }
  // If the system refuses, the node's thread was refused, too, and has said so (node/realtime.hpp).
  if (realtime_priority_ > 0) make_this_thread_realtime(realtime_priority_);
}

}  // namespace organ_collision
