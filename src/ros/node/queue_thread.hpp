#pragma once

#include <ros/callback_queue.h>

#include <atomic>
#include <thread>

namespace organ_collision {

/// A thread that calls the callbacks of its own queue, with lowered priority: for work that no step
/// waits for. It ends with this object at the latest.
class QueueThread {
 public:
  QueueThread();
  ~QueueThread();
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
