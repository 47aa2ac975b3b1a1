#include "step_workers.hpp"

#include <functional>

#include "ros/threads/realtime.hpp"

namespace organ_collision {

StepWorkers::StepWorkers(const NodeParameters& parameters)
    : workers_(thread_count(parameters.threads), parameters.picker,
               [priority = parameters.realtime.priority] {
                 // If the system refuses, the node's thread was refused, too, and has said so.
                 if (priority > 0) make_this_thread_realtime(priority);
               }) {
  // Already here, because a thread costs milliseconds if memory is locked.
  workers_.start_for(parameters.tools.size());
}

void StepWorkers::run(const StepEvaluator& evaluator, std::vector<DueStep>& steps,
                      const Deliver& deliver) {
  const auto work = [&](std::size_t worker, std::size_t step) {
    if (!steps[step].answer) evaluator.evaluate(steps[step], workers_.query(worker));
  };
  workers_.run(steps.size(), std::ref(work), deliver);  // The reference spares an allocation.
}

}  // namespace organ_collision
