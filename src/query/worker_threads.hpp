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

/// The number of threads that a user asks for; 0: one for each processor.
std::size_t thread_count(int asked_for);

/// Threads that do numbered tasks together with the thread that calls run(). The results are
/// delivered in the order of the tasks, in the calling thread. What is delivered therefore does not
/// depend on the number of threads, if a task does not depend on the others.
///
/// Each worker has a number, so that it can have data of its own. Worker 0 is the calling thread.
class WorkerThreads {
 public:
  using Prepare = std::function<void(std::size_t worker)>;
  using Work = std::function<void(std::size_t worker, std::size_t task)>;
  using Deliver = std::function<void(std::size_t task)>;

  /// `prepare` is called in each new thread before its first task.
  explicit WorkerThreads(Prepare prepare) : prepare_(std::move(prepare)) {}
  /// Waits for the threads to end.
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  /// Starts threads until there are `count` of them. Each joins in when it is prepared. Throws
  /// std::system_error if the system refuses a thread.
  void start(std::size_t count);

  /// Does the tasks 0 to count - 1: each idle worker begins the next one. The calling thread
  /// delivers what is ready between two tasks of its own. Returns when all are delivered. If a task
  /// or a delivery throws, no later task is begun or delivered, and the exception of the first such
  /// task is thrown when no worker works any more. Also throws what a thread threw when it was
  /// prepared.
  void run(std::size_t count, const Work& work, const Deliver& deliver);
  /// For a task or a delivery: no further task is begun. The tasks that are begun are the first
  /// ones, because they are begun in their order, and are still delivered.
  void skip_rest();

 private:
  using Lock = std::unique_lock<std::mutex>;

  void live(std::size_t worker);
  void do_task(std::size_t worker, Lock& lock);
  template <typename Action>
  void attempt(std::size_t task, Lock& lock, const Action& action);

  const Prepare prepare_;
  std::vector<std::thread> threads_;

  std::mutex mutex_;  ///< guards all that follows
  std::condition_variable has_tasks_, has_results_;
  const Work* work_ = nullptr;
  std::vector<char> done_;   ///< by task
  std::size_t next_ = 0;     ///< the next task to begin
  std::size_t end_ = 0;      ///< the tasks from here on are not begun
  std::size_t working_ = 0;  ///< the number of tasks that are begun and not done
  std::exception_ptr error_;
  std::exception_ptr unprepared_;  ///< why a thread could not be prepared
  bool stop_ = false;
};

/// Workers that each have a query, and with it a GL context, of their own.
template <typename Query>
class QueryThreads {
 public:
  /// At most `count` workers, the calling thread included. Threads are started when there are tasks
  /// for them. `settle` is called in each when its query is made.
  QueryThreads(std::size_t count, const PickerSettings& picker, std::function<void()> settle = {})
      : queries_(count), threads_([this, picker, settle](std::size_t worker) {
          queries_[worker] = std::make_unique<Query>(picker);
          if (settle) settle();
        }) {
    queries_.front() = std::make_unique<Query>(picker);
  }

  std::size_t count() const { return queries_.size(); }
  /// The query of a worker, for the tasks of this worker. That of worker 0 is always there.
  Query& query(std::size_t worker) const { return *queries_[worker]; }
  void start_for(std::size_t tasks) {
    if (tasks > 1) threads_.start(std::min(tasks, count()) - 1);
  }
  /// See WorkerThreads.
  void run(std::size_t tasks, const WorkerThreads::Work& work,
           const WorkerThreads::Deliver& deliver) {
    start_for(tasks);
    threads_.run(tasks, work, deliver);
  }
  void skip_rest() { threads_.skip_rest(); }

 private:
  std::vector<std::unique_ptr<Query>> queries_;  ///< by worker
  WorkerThreads threads_;  ///< the last member: its threads end before what they use
};

}  // namespace organ_collision
