#include "queue_thread.hpp"

#include <new>

#include "ros/interface/thread_scheduling.hpp"

namespace organ_collision {
namespace {

/// How soon the thread notices that it is to end.
const ros::WallDuration kLongestWait(0.05);

}  // namespace

QueueThread::QueueThread() : thread_([this] { work(); }) {}

QueueThread::~QueueThread() { stop(); }

void QueueThread::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void QueueThread::work() {
  lower_priority_of_this_thread();
  while (!stop_) {
    try {
      queue_.callOne(kLongestWait);
    } catch (const std::bad_alloc&) {  // The callback is lost. The next one may have more memory.
    }
  }
}

}  // namespace organ_collision
