#pragma once

#include <ros/callback_queue.h>

#include <functional>

namespace organ_collision {

/// Runs an action in the thread that calls the callbacks of a queue, and waits for its end. Must be
/// called in another thread. Rethrows what the action throws. Throws std::runtime_error if the
/// queue is cleared or disabled before the action begins, as when its node ends.
void run_in_thread_of(ros::CallbackQueue& queue, const std::function<void()>& action);

}  // namespace organ_collision
