#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <atomic>
#include <functional>
#include <thread>

namespace organ_collision {

/// Lets the thread that owns `queue` call `function`, once. If the function throws, it ends the
/// work of that thread.
void call_later(ros::CallbackQueueInterface& queue, std::function<void()> function);

/// Runs an action in the thread that calls the callbacks of `queue`, and waits for the action's
/// end. Must be called in another thread. Rethrows what the action throws. Throws
/// std::runtime_error if the queue is cleared or disabled before the action begins, as when its
/// node ends.
void run_in_thread_of(ros::CallbackQueue& queue, const std::function<void()>& action);

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
