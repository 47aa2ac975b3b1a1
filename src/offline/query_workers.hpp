#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "query/workers/worker_threads.hpp"

namespace organ_collision {

/// The calling thread and further ones, which do tasks side by side. Each has a CollisionQuery of
/// its own. A thread is started when there are tasks for it.
class QueryWorkers {
 public:
  /// At most `count` threads, at least 1. Throws GlError if OpenGL picking does not work.
  QueryWorkers(std::size_t count, const PickerSettings& picker);

  std::size_t count() const { return queries_.size(); }
  /// The query of a worker, for the tasks of this worker.
  CollisionQuery& query(std::size_t worker) { return *queries_[worker]; }
  /// See WorkerThreads::run().
  void run(std::size_t tasks, const WorkerThreads::Work& work,
           const WorkerThreads::Deliver& deliver);

 private:
  std::vector<std::optional<CollisionQuery>> queries_;  ///< of each worker
  WorkerThreads workers_;
};

}  // namespace organ_collision
