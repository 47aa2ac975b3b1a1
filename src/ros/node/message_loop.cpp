#include "message_loop.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>

namespace organ_collision {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

/// The node waits at most this long for a callback, so that it notices a stop and a clock jump.
constexpr std::chrono::milliseconds kLongestWait(10);
/// The node calls callbacks for at most this long before it works on what they brought.
constexpr std::chrono::milliseconds kLongestDrain(2);
/// In simulated time, the node looks this often whether a deadline has passed.
constexpr std::chrono::milliseconds kShortestSimulatedWait(1);
/// If the node cannot keep up with its messages, shapes wait at most this much longer than
/// tf_timeout_sec for their transforms.
constexpr std::chrono::seconds kLongestBacklog(1);

}  // namespace

void MessageLoop::receive(std::optional<SteadyTime> deadline) {
  SteadyTime before = clock_.now();
  bool called = call_one(wait(deadline, before));
  const SteadyTime end = SteadyClock::now() + kLongestDrain;
  while (called && SteadyClock::now() < end) {
    before = clock_.now();
    called = call_one(ros::WallDuration(0.0));
  }
  // A transform may be among the callbacks that are left. The time that they take does not count.
  heard_until_ = called ? std::max(heard_until_, before - kLongestBacklog) : before;
}

/// How long to wait for the first callback.
ros::WallDuration MessageLoop::wait(std::optional<SteadyTime> deadline, SteadyTime now) const {
  std::chrono::nanoseconds wait = kLongestWait;
  if (deadline) wait = std::min<std::chrono::nanoseconds>(wait, *deadline - now);
  // Simulated time goes on in jumps, and no callback tells of them.
  const auto shortest = ros::Time::isSimTime() ? kShortestSimulatedWait : 0ms;
  return ros::WallDuration().fromNSec(std::max<std::chrono::nanoseconds>(wait, shortest).count());
}

/// Returns false if there was no callback.
bool MessageLoop::call_one(ros::WallDuration wait) {
  actions_.watch_clock();
  bool called = true;
  guard([&] { called = queue_.callOne(wait) == ros::CallbackQueue::Called; });
  actions_.watch_clock();
  guard([this] { actions_.handle(clock_.now()); });
  return called;
}

void MessageLoop::guard(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {  // Usually std::bad_alloc.
    rejected_.add("exception", std::string("something was left out: ") + error.what(),
                  SteadyClock::now());
  }
}

void MessageLoop::end() {
  queue_.disable();
  queue_.clear();
}

ros::NodeHandle on_queue(ros::NodeHandle node, ros::CallbackQueue& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

}  // namespace organ_collision
