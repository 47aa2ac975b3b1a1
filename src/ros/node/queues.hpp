#pragma once

#include <ros/callback_queue.h>
#include <ros/callback_queue_interface.h>

#include <boost/make_shared.hpp>
#include <functional>
#include <utility>

namespace organ_collision {

/// A function in a callback queue of roscpp. It is called once, by the thread that owns the queue.
/// It must not throw.
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

/// Lets the thread that owns `queue` call `function`.
inline void call_later(ros::CallbackQueueInterface& queue, std::function<void()> function) {
  queue.addCallback(boost::make_shared<FunctionCallback>(std::move(function)));
}

/// Runs an action in the thread that calls the callbacks of a queue, and waits for its end. Must be
/// called in another thread. Rethrows what the action throws. Throws std::runtime_error if the
/// queue is cleared or disabled before the action begins, as when its node ends.
void run_in_thread_of(ros::CallbackQueue& queue, const std::function<void()>& action);

}  // namespace organ_collision
