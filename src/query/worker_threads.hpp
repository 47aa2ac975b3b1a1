#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace organ_collision {

/// The number of threads that a user asks for; 0: one for each processor.
std::size_t thread_count(int asked_for);

/// Threads that share numbered tasks. The results are delivered one after the other, in the order
/// of the tasks, in the thread that calls run(). What is delivered therefore does not depend on the
/// number of threads, if a task does not depend on the others.
///
/// Each worker has a number, so that it can have data of its own, such as a CollisionQuery. Worker
/// 0 is the thread that calls run(); the others are threads of this object.
class WorkerThreads {
 public:
  /// What the thread that calls run() does. kWorks: it does tasks, too. Results that are ready wait
  /// for at most one task and 0.2 ms before it delivers them. kWaits: it only delivers.
  enum class Caller { kWorks, kWaits };
  /// Called in each new thread before its first task, with the worker's number from 1. If it
  /// throws, the worker gets no task; a later call of start() has it try again.
  using Prepare = std::function<void(std::size_t worker)>;
  /// Does one task. Called by several workers at the same time.
  using Work = std::function<void(std::size_t worker, std::size_t task)>;
  /// Takes the result of one task.
  using Deliver = std::function<void(std::size_t task)>;

  WorkerThreads(Caller caller, Prepare prepare);
  /// Waits for the threads to end.
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  /// Starts threads until there are `count` of them. Does not wait until they are prepared: they
  /// join in when they are. If the system refuses a thread, or one could not be prepared, fewer do
  /// the work, and this tries again after a second at the earliest. Call it in the thread that
  /// calls run().
  void start(std::size_t count);
  /// The number of threads that were started.
  std::size_t started() const { return threads_.size(); }
  /// Waits until each thread is prepared or has failed. Returns how many are prepared.
  std::size_t wait_until_prepared();

  /// Does the tasks 0 to count - 1 and delivers each. Returns when all are delivered. If a task or
  /// a delivery throws, no later task is begun or delivered, and the exception of the first such
  /// task is thrown when no worker works any more. If the caller only waits and no thread could be
  /// prepared, throws the exception of the preparation, or std::runtime_error if there are no
  /// threads.
  void run(std::size_t count, const Work& work, const Deliver& deliver);

 private:
  struct Task {
    bool done = false;
    std::exception_ptr error = nullptr;
  };
  class Round;
  using Lock = std::unique_lock<std::mutex>;
  using Clock = std::chrono::steady_clock;

  void live(std::size_t worker);
  bool prepare(std::size_t worker);
  void do_task(std::size_t worker, Lock& lock);
  void deliver_all(const Deliver& deliver, Lock& lock);
  void deliver_one(std::size_t task, const Deliver& deliver, Lock& lock);
  void wait_for_help(Lock& lock);
  bool has_open_task() const { return next_ < tasks_.size(); }

  const Caller caller_;
  const Prepare prepare_;
  std::vector<std::thread> threads_;
  bool is_short_of_threads_ = false;  ///< since the last attempt
  Clock::time_point next_try_;        ///< not before this

  std::mutex mutex_;  ///< guards all that follows
  std::condition_variable has_tasks_, has_results_;
  std::condition_variable may_try_again_;  ///< for the threads whose preparation failed
  const Work* work_ = nullptr;             ///< of the present round
  std::vector<Task> tasks_;                ///< of the present round
  std::size_t next_ = 0;                   ///< the next task to begin
  std::size_t working_ = 0;                ///< the number of tasks that are begun and not done
  std::size_t prepared_ = 0;               ///< the number of threads that are ready for tasks
  std::size_t failed_ = 0;                 ///< the number of threads whose preparation failed
  std::size_t tries_ = 0;  ///< counts the times that threads that failed are to try again
  std::exception_ptr why_failed_;
  bool stop_ = false;
};

}  // namespace organ_collision
