#include "queues.hpp"

#include "realtime.hpp"

namespace organ_collision {

ros::NodeHandle on_queue(ros::NodeHandle node, ros::CallbackQueue& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

void QueueThread::stop() {
  stop_ = true;
  queue_.disable();  // The thread need not wait for the stop period.
  if (thread_.joinable()) thread_.join();
}

void QueueThread::work() {
  const ros::WallDuration stop_period(0.05);  // [s] How long the thread may take to notice stop_.
  lower_priority_of_this_thread();
  while (!stop_) queue_.callOne(stop_period);
}

}  // namespace organ_collision
