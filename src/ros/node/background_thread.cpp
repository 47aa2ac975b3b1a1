#include "background_thread.hpp"

#include <new>

#include "ros/interface/thread_priority.hpp"

namespace organ_collision {
namespace {

/// How soon the thread notices that it is to end.
const ros::WallDuration kLongestWait(0.05);

}  // namespace

BackgroundThread::BackgroundThread() : thread_([this] { work(); }) {}

BackgroundThread::~BackgroundThread() { stop(); }

void BackgroundThread::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void BackgroundThread::work() {
  lower_priority_of_this_thread();
  while (!stop_) {
    try {
      queue_.callOne(kLongestWait);
    } catch (const std::bad_alloc&) {  // The callback is lost. The next one may have more memory.
    }
  }
}

}  // namespace organ_collision
