#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <atomic>
#include <functional>
#include <thread>

namespace organ_collision {

/// Lets the thread that owns `queue` call `function`, once. The function must not throw, unless an
/// exception is to end that thread's work.
void call_later(ros::CallbackQueueInterface& queue, std::function<void()> function);

/// Runs an action in the thread that calls the callbacks of a queue, and waits for its end. Must be
/// called in another thread. Rethrows what the action throws. Throws std::runtime_error if the
/// queue is cleared or disabled before the action begins, as when its node ends.
void run_in_thread_of(ros::CallbackQueue& queue, const std::function<void()>& action);

/// The same node handle, with its callbacks in `queue`.
ros::NodeHandle on_queue(ros::NodeHandle node, ros::CallbackQueue& queue);

/// A thread that calls the callbacks of its own queue, with lowered priority: for work that no step
/// waits for. It ends with this object at the latest.
class QueueThread {
 public:
  QueueThread() : thread_([this] { work(); }) {}
  ~QueueThread() { stop(); }
  QueueThread(const QueueThread&) = delete;
  QueueThread& operator=(const QueueThread&) = delete;

  /// Ends the thread after the callback that it is calling. What else is in the queue stays there.
  void stop();
  /// What is added to this queue is called in the thread.
  ros::CallbackQueue& queue() { return queue_; }

 private:
  void work();

  ros::CallbackQueue queue_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace organ_collision
