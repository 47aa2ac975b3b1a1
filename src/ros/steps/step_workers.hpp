#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "contact_array.hpp"
#include "query/worker_threads.hpp"
#include "step_evaluator.hpp"

namespace organ_collision {

/// Evaluates steps side by side. Each worker has a ContactQuery, and with it a GL context, of its
/// own. The calling thread is one of the workers. There are as many as there are tools, or more if
/// more steps are due at once, but at most `threads`. A new worker joins in when its context is
/// made, after about 30 ms.
class StepWorkers {
 public:
  using Deliver = WorkerThreads::Deliver;

  /// Takes picker, threads and priority. Throws GlError if GL picking does not work on this
  /// machine.
  explicit StepWorkers(const NodeParameters& parameters);

  /// Evaluates the steps that have no answer yet, and delivers all in their order, in the calling
  /// thread. At the end of this call, no other thread works.
  void run(const StepEvaluator& evaluator, std::vector<DueStep>& steps, const Deliver& deliver);

  const std::string& gl_version() const { return queries_.front()->gl_version(); }

 private:
  void start_for(std::size_t steps);
  void prepare(std::size_t worker);

  const PickerSettings picker_;
  const int realtime_priority_;                         ///< 0: ordinary scheduling
  std::vector<std::unique_ptr<ContactQuery>> queries_;  ///< by worker
  WorkerThreads threads_;  ///< the last member: its threads end before what they use
};

}  // namespace organ_collision
