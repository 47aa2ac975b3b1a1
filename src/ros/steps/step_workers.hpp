#pragma once

#include <string>
#include <vector>

#include "contact_array.hpp"
#include "query/worker_threads.hpp"
#include "step_evaluator.hpp"

namespace organ_collision {

/// Evaluates steps side by side. The calling thread is one of the workers. There are as many as
/// there are tools, or more if more steps are due at once, but at most `threads`. A new worker
/// joins in when its GL context is made, after about 30 ms.
class StepWorkers {
 public:
  using Deliver = WorkerThreads::Deliver;

  /// Takes picker, threads and priority. Throws GlError if GL picking does not work on this
  /// machine, and std::system_error if the system refuses a thread.
  explicit StepWorkers(const NodeParameters& parameters);

  /// Evaluates the steps that have no answer yet, and delivers all in their order, in the calling
  /// thread. At the end of this call, no other thread works.
  void run(const StepEvaluator& evaluator, std::vector<DueStep>& steps, const Deliver& deliver);

  const std::string& gl_version() const { return workers_.query(0).gl_version(); }

 private:
  QueryThreads<ContactQuery> workers_;
};

}  // namespace organ_collision
