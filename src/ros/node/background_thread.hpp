#pragma once

#include <ros/callback_queue.h>

#include <atomic>
#include <thread>

namespace organ_collision {

/// A thread for work that no step waits for. Where processors are scarce, it leaves them to the
/// node's thread. It ends with this object at the latest.
class BackgroundThread {
 public:
  BackgroundThread();
  ~BackgroundThread();
  BackgroundThread(const BackgroundThread&) = delete;
  BackgroundThread& operator=(const BackgroundThread&) = delete;

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
