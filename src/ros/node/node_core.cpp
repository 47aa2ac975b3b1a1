#include "node_core.hpp"

#include <ros/console.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/messages/text.hpp"
#include "ros/tools/robot_reply.hpp"
#include "scheduling.hpp"

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

namespace {

/// A tool that would stop working is refused. One that did not work before may go on so.
void check(const std::vector<Tool>& tools, const KeptTools& kept) {
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (!kept[tool] && !tools[tool].fault.empty()) throw ToolError(tools[tool].fault);
  }
}

}  // namespace

std::vector<Tool> load_tools(const std::vector<ToolParameters>& parameters,
                             const ros::NodeHandle& private_node) {
  std::vector<Tool> tools;
  for (const ToolParameters& of_tool : parameters) {
    tools.push_back(load_tool(of_tool, private_node));
  }
  return tools;
}

void warn_of_settings(const std::vector<Tool>& tools, const std::vector<std::string>& misspelt) {
  for (const std::string& sentence : misspelt) ROS_WARN("%s", sentence.c_str());
  for (const Tool& tool : tools) {
    if (!tool.fault.empty()) ROS_ERROR("%s", tool.fault.c_str());
  }
  if (tools.empty()) ROS_WARN("%s", kNoTools);
  for (const Tool& tool : tools) {
    if (!tool.parameters.has_shaft()) continue;
    const std::string doubt = doubt_about_radius(tool.parameters.name, tool.parameters.radius);
    if (!doubt.empty()) ROS_WARN("%s", doubt.c_str());
  }
}

ToolReload::ToolReload(ros::NodeHandle private_node, const std::vector<Tool>& tools, Load load,
                       Exchange exchange)
    : private_node_(private_node),
      tools_(tools),
      load_(std::move(load)),
      exchange_(std::move(exchange)) {}

void ToolReload::advertise() {
  server_ = private_node_.advertiseService(names::kReloadTools, &ToolReload::on_reload, this);
}

bool ToolReload::on_reload(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  try {
    response.message = plain_text(reload(), kLongestMessage);
    response.success = true;
    ROS_INFO("tools are reloaded: %s", response.message.c_str());
  } catch (const std::exception& error) {
    response.message = plain_text(error.what(), kLongestMessage);
    ROS_WARN("tools stay as they were: %s", response.message.c_str());
  }
  return true;
}

/// Returns which tools are new, changed, unchanged and removed.
std::string ToolReload::reload() {
  LoadedTools parameters = load_();
  LoadedToolList loaded{load_tools(parameters.tools, private_node_),
                        std::move(parameters.misspelt)};
  const ToolChanges changes = compare_tools(tools_, loaded.tools);
  check(loaded.tools, changes.kept);
  exchange_(loaded, changes.kept);
  return changes.summary;
}

}  // namespace organ_collision
