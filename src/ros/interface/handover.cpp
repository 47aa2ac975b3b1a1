#include "handover.hpp"

#include <boost/make_shared.hpp>
#include <future>
#include <stdexcept>

namespace organ_collision {
namespace {

/// If the queue drops it, its task is destroyed, which ends the wait.
class Task : public ros::CallbackInterface {
 public:
  explicit Task(std::packaged_task<void()> task) : task_(std::move(task)) {}
  CallResult call() override {
    task_();
    return Success;
  }

 private:
  std::packaged_task<void()> task_;
};

}  // namespace

void run_in_thread_of(ros::CallbackQueue& queue, const std::function<void()>& action) {
  std::packaged_task<void()> task(action);
  std::future<void> end = task.get_future();
  queue.addCallback(boost::make_shared<Task>(std::move(task)));
  try {
    end.get();
  } catch (const std::future_error&) {
    throw std::runtime_error("the node is about to end");
  }
}

}  // namespace organ_collision
