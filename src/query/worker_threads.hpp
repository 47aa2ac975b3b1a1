#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "organ_collision/picking/picker_settings.hpp"

namespace organ_collision {

/// The number of threads for the number that a user asks for: 0 means one for each processor.
std::size_t thread_count(int asked_for);

/// Threads that do numbered tasks together with the thread that calls run(). The results are
/// delivered in the order of the tasks, in the calling thread. If no task depends on another one,
/// therefore, what is delivered does not depend on the number of threads.
///
/// Each worker has a number, by which it can have data of its own. Worker 0 is the thread that
/// calls run().
class WorkerThreads {
 public:
  using Prepare = std::function<void(std::size_t worker)>;
  using Work = std::function<void(std::size_t worker, std::size_t task)>;
  using Deliver = std::function<void(std::size_t task)>;

  /// `prepare` is called in each new thread before the first task of the thread.
  explicit WorkerThreads(Prepare prepare) : prepare_(std::move(prepare)) {}
  /// Waits for the threads to end.
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  /// Starts threads until there are `count` of them. Each thread takes tasks as soon as it is
  /// prepared. Throws std::system_error if the system refuses a thread.
  void start(std::size_t count);

  /// Does the tasks 0 to count - 1: each idle worker begins the next task. The calling thread
  /// delivers results that are ready between two tasks of its own. Returns when all results are
  /// delivered. If a task or its delivery throws, no later task is begun or delivered. When no
  /// worker works any more, the exception of the first task that failed is thrown. Also throws the
  /// exception of an earlier call of `prepare` that failed.
  void run(std::size_t count, const Work& work, const Deliver& deliver);
  /// Lets no further task begin. A task or a delivery may call it. Tasks are begun in their order,
  /// so those that have been begun are the first ones. Their results are still delivered.
  void skip_rest();

 private:
  using Lock = std::unique_lock<std::mutex>;

  void live(std::size_t worker);
  void do_task(std::size_t worker, Lock& lock);
  template <typename Action>
  void attempt(std::size_t task, Lock& lock, const Action& action);

  const Prepare prepare_;
  std::vector<std::thread> threads_;

  std::mutex mutex_;  ///< guards all members below
  std::condition_variable has_tasks_, has_results_;
  const Work* work_ = nullptr;
  std::vector<char> done_;   ///< for each task, whether it is done
  std::size_t next_ = 0;     ///< the next task to begin
  std::size_t end_ = 0;      ///< tasks from this one on are neither begun nor delivered
  std::size_t working_ = 0;  ///< the number of tasks that are begun and not done
  std::exception_ptr error_;
  std::exception_ptr unprepared_;  ///< why a thread could not be prepared
  bool stop_ = false;
};

/// Worker threads. Each worker has its own query, and so its own GL context.
template <typename Query>
class QueryThreads {
 public:
  /// Makes at most `count` workers, including the calling thread. Threads are started when there
  /// are tasks for them. `settle` is called in each new thread when its query is made.
  QueryThreads(std::size_t count, const PickerSettings& picker, std::function<void()> settle = {})
      : queries_(count), threads_([this, picker, settle](std::size_t worker) {
          queries_[worker] = std::make_unique<Query>(picker);
          if (settle) settle();
        }) {
    queries_.front() = std::make_unique<Query>(picker);
  }

  std::size_t count() const { return queries_.size(); }
  /// The query of a worker, for the tasks of this worker. Worker 0 always has a query.
  Query& query(std::size_t worker) const { return *queries_[worker]; }
  void start_for(std::size_t tasks) {
    if (tasks > 1) threads_.start(std::min(tasks, count()) - 1);
  }
  /// See WorkerThreads::run().
  void run(std::size_t tasks, const WorkerThreads::Work& work,
           const WorkerThreads::Deliver& deliver) {
    start_for(tasks);
    threads_.run(tasks, work, deliver);
  }
  void skip_rest() { threads_.skip_rest(); }

 private:
  std::vector<std::unique_ptr<Query>> queries_;  ///< for each worker
  WorkerThreads threads_;  ///< the last member, so that its threads end before queries_
};

}  // namespace organ_collision
