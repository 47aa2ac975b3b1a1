#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <atomic>
#include <boost/make_shared.hpp>
#include <functional>
#include <future>
#include <stdexcept>
#include <thread>
#include <utility>

namespace organ_collision {

/// A function as a callback of roscpp.
template <typename Function>
class FunctionCallback : public ros::CallbackInterface {
 public:
  explicit FunctionCallback(Function function) : function_(std::move(function)) {}

  CallResult call() override {
    function_();
    return Success;
  }

 private:
  Function function_;
};

/// Lets the thread that owns `queue` call `function`, once. If the function throws, it ends the
/// work of that thread.
template <typename Function>
void call_later(ros::CallbackQueueInterface& queue, Function function) {
  queue.addCallback(boost::make_shared<FunctionCallback<Function>>(std::move(function)));
}

/// Runs an action in the thread that calls the callbacks of `queue`, and waits for the action's
/// end. Must be called in another thread. Rethrows what the action throws. Throws
/// std::runtime_error if the queue is cleared or disabled before the action begins, as when its
/// node ends.
template <typename Action>
void run_in_thread_of(ros::CallbackQueue& queue, const Action& action) {
  std::packaged_task<void()> task(std::cref(action));
  std::future<void> end = task.get_future();
  // Only the callback owns the task. If the queue drops the callback, the task is destroyed, and
  // end.get() throws instead of waiting for ever.
  call_later(queue, std::move(task));
  try {
    end.get();
  } catch (const std::future_error&) {
    throw std::runtime_error("the node is about to end");
  }
}

/// A copy of the node handle whose callbacks go to `queue`.
ros::NodeHandle on_queue(ros::NodeHandle node, ros::CallbackQueue& queue);

/// A thread with lowered priority that calls the callbacks of its own queue: for work that no step
/// waits for. The destructor ends the thread.
class QueueThread {
 public:
  QueueThread() : thread_([this] { work(); }) {}
  ~QueueThread() { stop(); }

  /// Ends the thread after its present callback. Callbacks that still wait are not called.
  void stop();
  /// The queue whose callbacks the thread calls.
  ros::CallbackQueue& queue() { return queue_; }

 private:
  void work();

  ros::CallbackQueue queue_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace organ_collision
