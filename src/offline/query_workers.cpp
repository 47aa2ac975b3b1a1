#include "query_workers.hpp"

#include <algorithm>

namespace organ_collision {

QueryWorkers::QueryWorkers(std::size_t count, const PickerSettings& picker)
    : queries_(count), workers_(WorkerThreads::Caller::kWorks, [this, picker](std::size_t worker) {
        queries_[worker].emplace(picker);
      }) {
  queries_[0].emplace(picker);
}

void QueryWorkers::run(std::size_t tasks, const WorkerThreads::Work& work,
                       const WorkerThreads::Deliver& deliver) {
  if (tasks > 1) workers_.start(std::min(tasks, count()) - 1);
  workers_.run(tasks, work, deliver);
}

}  // namespace organ_collision
