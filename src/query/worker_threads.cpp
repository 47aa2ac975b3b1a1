#include "worker_threads.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace organ_collision {
namespace {

/// A caller that works holds results back for about this long, while tasks are left to begin. To
/// deliver results back to back costs less: the thread that receives them is woken only once.
constexpr std::chrono::microseconds kLongestHold(200);
/// Between two attempts to start or to prepare a thread.
constexpr std::chrono::seconds kPause(1);

}  // namespace

std::size_t thread_count(int asked_for) {
  if (asked_for > 0) return static_cast<std::size_t>(asked_for);
  return std::max(1u, std::thread::hardware_concurrency());  // 0: the system does not tell.
}

/// The tasks of one call of run(). At its end, also by an exception, no worker works any more, so
/// that what the tasks refer to may end.
class WorkerThreads::Round {
 public:
  Round(WorkerThreads& threads, std::size_t count, const Work& work, Lock& lock)
      : threads_(threads), lock_(lock) {
    threads_.tasks_.assign(count, {});
    threads_.next_ = 0;
    threads_.work_ = &work;
  }
  ~Round() {
    if (!lock_) lock_.lock();
    threads_.next_ = threads_.tasks_.size();
    threads_.has_results_.wait(lock_, [this] { return threads_.working_ == 0; });
    threads_.tasks_.clear();
    threads_.next_ = 0;
  }
  Round(const Round&) = delete;
  Round& operator=(const Round&) = delete;

 private:
  WorkerThreads& threads_;
  Lock& lock_;
};

WorkerThreads::WorkerThreads(Caller caller, Prepare prepare)
    : caller_(caller), prepare_(std::move(prepare)) {}

WorkerThreads::~WorkerThreads() {
  {
    const Lock lock(mutex_);
    stop_ = true;
  }
  has_tasks_.notify_all();
  may_try_again_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerThreads::start(std::size_t count) {
  if (is_short_of_threads_ && Clock::now() < next_try_) return;
  is_short_of_threads_ = false;
  try {
    while (threads_.size() < count) {
      threads_.emplace_back([this, worker = threads_.size() + 1] { live(worker); });
    }
  } catch (const std::system_error&) {  // The system refuses a thread: fewer do the work.
    is_short_of_threads_ = true;
  }
  const Lock lock(mutex_);
  if (failed_ > 0) {
    is_short_of_threads_ = true;
    failed_ = 0;
    ++tries_;
    may_try_again_.notify_all();
  }
  next_try_ = Clock::now() + kPause;
}

std::size_t WorkerThreads::wait_until_prepared() {
  Lock lock(mutex_);
  has_results_.wait(lock, [this] { return prepared_ + failed_ == threads_.size(); });
  return prepared_;
}

void WorkerThreads::run(std::size_t count, const Work& work, const Deliver& deliver) {
  Lock lock(mutex_);
  if (caller_ == Caller::kWaits && count > 0) wait_for_help(lock);
  const Round round(*this, count, work, lock);
  const std::size_t for_others = caller_ == Caller::kWorks && count > 0 ? count - 1 : count;
  for (std::size_t i = 0; i < for_others && i < prepared_; ++i) has_tasks_.notify_one();
  deliver_all(deliver, lock);
}

void WorkerThreads::live(std::size_t worker) {
  while (!prepare(worker)) {
    Lock lock(mutex_);
    const std::size_t tries = tries_;
    ++failed_;
    has_results_.notify_all();
    may_try_again_.wait(lock, [&] { return stop_ || tries_ != tries; });
    if (stop_) return;
  }
  Lock lock(mutex_);
  ++prepared_;
  has_results_.notify_all();
  while (true) {
    has_tasks_.wait(lock, [this] { return stop_ || has_open_task(); });
    if (stop_) return;
    do_task(worker, lock);
  }
}

bool WorkerThreads::prepare(std::size_t worker) {
  try {
    prepare_(worker);
    return true;
  } catch (...) {
    const Lock lock(mutex_);
    why_failed_ = std::current_exception();
    return false;
  }
}

/// Begins the next task, which must exist, and does it without the lock.
void WorkerThreads::do_task(std::size_t worker, Lock& lock) {
  const std::size_t task = next_++;
  const Work& work = *work_;
  ++working_;
  lock.unlock();
  std::exception_ptr error;
  try {
    work(worker, task);
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  --working_;
  if (error) next_ = tasks_.size();
  tasks_[task] = {true, std::move(error)};
  if (worker != 0) has_results_.notify_one();
}

void WorkerThreads::deliver_all(const Deliver& deliver, Lock& lock) {
  auto last_delivery = Clock::now();
  std::size_t next = 0;  // The next task to deliver.
  while (next < tasks_.size()) {
    const bool does_tasks = caller_ == Caller::kWorks && has_open_task();
    const bool is_due = !does_tasks || Clock::now() - last_delivery > kLongestHold;
    if (is_due && tasks_[next].done) {
      deliver_one(next++, deliver, lock);
      if (next == tasks_.size() || !tasks_[next].done) last_delivery = Clock::now();
    } else if (does_tasks) {
      do_task(0, lock);
    } else {
      has_results_.wait(lock, [&] { return tasks_[next].done; });
    }
  }
}

void WorkerThreads::deliver_one(std::size_t task, const Deliver& deliver, Lock& lock) {
  if (tasks_[task].error) std::rethrow_exception(tasks_[task].error);
  lock.unlock();
  deliver(task);
  lock.lock();
}

/// Waits until there is a thread for the tasks of a caller that does none.
void WorkerThreads::wait_for_help(Lock& lock) {
  has_results_.wait(lock, [this] { return prepared_ > 0 || failed_ == threads_.size(); });
  if (prepared_ > 0) return;
  if (why_failed_) std::rethrow_exception(why_failed_);
  throw std::runtime_error("no thread could be started");
}

}  // namespace organ_collision
