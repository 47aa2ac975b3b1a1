#include "background_thread.hpp"

#include <sys/resource.h>

#include <new>

namespace organ_collision {
namespace {

/// From 0 (ordinary) to 19: how much the thread yields to others.
constexpr int kNiceness = 10;
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
  // On Linux, the niceness belongs to the calling thread alone. If it cannot be set, the thread
  // works all the same.
  setpriority(PRIO_PROCESS, 0, kNiceness);
  while (!stop_) {
    try {
      queue_.callOne(kLongestWait);
    } catch (const std::bad_alloc&) {  // The callback is lost. The next one may have more memory.
    }
  }
}

}  // namespace organ_collision
