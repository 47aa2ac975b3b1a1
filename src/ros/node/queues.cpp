#include "queues.hpp"

#include <future>
#include <memory>
#include <stdexcept>

namespace organ_collision {

void run_in_thread_of(ros::CallbackQueue& queue, const std::function<void()>& action) {
  auto task = std::make_shared<std::packaged_task<void()>>(action);
  std::future<void> end = task->get_future();
  // The callback alone owns the task. If the queue drops it, the task ends, and with it the wait.
  call_later(queue, [task = std::move(task)] { (*task)(); });
  try {
    end.get();
  } catch (const std::future_error&) {
    throw std::runtime_error("the node is about to end");
  }
}

}  // namespace organ_collision
