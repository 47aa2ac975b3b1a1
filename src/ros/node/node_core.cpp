#include "node_core.hpp"

#include <ros/console.h>

#include <algorithm>
#include <chrono>
#include <exception>

#include "ros/messages/conversions.hpp"
#include "ros/tools/robot_reply.hpp"

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
  // If callbacks are left, a transform may be among them. heard_until_ then stays as it is, so that
  // no shape misses its transform, but it stays at most kLongestBacklog behind.
  heard_until_ = called ? std::max(heard_until_, before - kLongestBacklog) : before;
}

/// How long to wait for the first callback.
ros::WallDuration MessageLoop::wait(std::optional<SteadyTime> deadline, SteadyTime now) const {
  std::chrono::nanoseconds wait = kLongestWait;
  if (deadline) wait = std::min<std::chrono::nanoseconds>(wait, *deadline - now);
  // Simulated time advances in jumps, and no callback tells of them. The node must look for them:
  // `shortest` is the pause between two looks.
  const auto shortest = ros::Time::isSimTime() ? kShortestSimulatedWait : 0ms;
  return ros::WallDuration().fromNSec(std::max<std::chrono::nanoseconds>(wait, shortest).count());
}

/// Calls one callback, and the node's own functions around it. Returns false if there was none.
bool MessageLoop::call_one(ros::WallDuration wait) {
  callbacks_.watch_clock();
  const bool called = queue_.callOne(wait) == ros::CallbackQueue::Called;
  callbacks_.watch_clock();
  callbacks_.handle(clock_.now());
  return called;
}

void MessageLoop::end() {
  queue_.disable();
  queue_.clear();
}

void warn_of_settings(const std::vector<Tool>& tools, const std::vector<std::string>& misspelt) {
  for (const std::string& sentence : misspelt) ROS_WARN("%s", sentence.c_str());
  if (tools.empty()) ROS_WARN("%s", kNoTools);
  for (const Tool& tool : tools) {
    if (!tool.fault.empty()) ROS_ERROR("%s", tool.fault.c_str());
    for (const std::string& doubt : doubts(tool)) ROS_WARN("%s", doubt.c_str());
  }
}

ToolChanges accepted_changes(const std::vector<Tool>& old_tools,
                             const std::vector<Tool>& new_tools) {
  ToolChanges changes = compare_tools(old_tools, new_tools);
  for (std::size_t tool = 0; tool < new_tools.size(); ++tool) {
    const std::string& fault = new_tools[tool].fault;
    if (!changes.kept[tool] && !fault.empty()) throw ToolError(fault);
  }
  return changes;
}

}  // namespace organ_collision
