#include "worker_threads.hpp"

namespace organ_collision {

std::size_t thread_count(int asked_for) {
  if (asked_for > 0) return static_cast<std::size_t>(asked_for);
  return std::max(1u, std::thread::hardware_concurrency());  // It is 0 if it is unknown.
}

/// Runs `action` for a task while the lock is released. If the action throws, no task from this one
/// on is begun or delivered any more.
template <typename Action>
void WorkerThreads::attempt(std::size_t task, Lock& lock, const Action& action) {
  std::exception_ptr error;
  lock.unlock();
  try {
    action();
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  if (!error || task >= end_) return;
  end_ = task;
  error_ = error;
}

WorkerThreads::~WorkerThreads() {
  {
    const Lock lock(mutex_);
    stop_ = true;
  }
  has_tasks_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerThreads::start(std::size_t count) {
  while (threads_.size() < count) {
    threads_.emplace_back([this, worker = threads_.size() + 1] { live(worker); });
  }
}

void WorkerThreads::run(std::size_t count, const Work& work, const Deliver& deliver) {
  Lock lock(mutex_);
  if (unprepared_) std::rethrow_exception(unprepared_);
  work_ = &work;
  done_.assign(count, false);
  next_ = 0;
  end_ = count;
  error_ = nullptr;
  for (std::size_t i = 1; i < count && i <= threads_.size(); ++i) has_tasks_.notify_one();
  for (std::size_t task = 0; task < end_;) {
    if (done_[task]) {
      attempt(task, lock, [&] { deliver(task); });
      ++task;
    } else if (next_ < end_) {
      do_task(0, lock);
    } else {
      has_results_.wait(lock, [&] { return done_[task] || task >= end_; });
    }
  }
  end_ = 0;
  has_results_.wait(lock, [this] { return working_ == 0; });
  if (error_) std::rethrow_exception(error_);
}

void WorkerThreads::skip_rest() {
  const Lock lock(mutex_);
  end_ = std::min(end_, next_);
}

void WorkerThreads::live(std::size_t worker) {
  try {
    prepare_(worker);
  } catch (...) {
    const Lock lock(mutex_);
    unprepared_ = std::current_exception();
    return;
  }
  Lock lock(mutex_);
  while (true) {
    has_tasks_.wait(lock, [this] { return stop_ || next_ < end_; });
    if (stop_) return;
    do_task(worker, lock);
  }
}

/// Begins the next task and does it. There must be a next task.
void WorkerThreads::do_task(std::size_t worker, Lock& lock) {
  const std::size_t task = next_++;
  ++working_;
  attempt(task, lock, [&, work = work_] { (*work)(worker, task); });
  --working_;
  done_[task] = true;
  if (worker != 0) has_results_.notify_one();
}

}  // namespace organ_collision
