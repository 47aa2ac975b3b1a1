#include "queues.hpp"

#include <boost/make_shared.hpp>
#include <future>
#include <memory>
#include <stdexcept>
#include <utility>

#include "realtime.hpp"

namespace organ_collision {
namespace {

/// Wraps a function as a callback of roscpp.
class FunctionCallback : public ros::CallbackInterface {
 public:
  explicit FunctionCallback(std::function<void()> function) : function_(std::move(function)) {}

  CallResult call() override {
    function_();
    return Success;
  }

 private:
  std::function<void()> function_;
};

}  // namespace

void call_later(ros::CallbackQueueInterface& queue, std::function<void()> function) {
  queue.addCallback(boost::make_shared<FunctionCallback>(std::move(function)));
}

void run_in_thread_of(ros::CallbackQueue& queue, const std::function<void()>& action) {
  auto task = std::make_shared<std::packaged_task<void()>>(action);
  std::future<void> end = task->get_future();
  // Only the callback owns the task. If the queue drops the callback, the task is destroyed, and
  // end.get() throws instead of waiting for ever.
  call_later(queue, [task = std::move(task)] { (*task)(); });
  try {
    end.get();
  } catch (const std::future_error&) {
    throw std::runtime_error("the node is about to end");
  }
}

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
