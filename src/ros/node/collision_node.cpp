#include "collision_node.hpp"

#include <algorithm>
#include <chrono>
#include <exception>

#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

/// The node waits at most this long for a callback, so that it notices a stop and a clock jump.
constexpr std::chrono::milliseconds kLongestWait(10);
/// The node calls callbacks for at most this long before it evaluates what they brought.
constexpr std::chrono::milliseconds kLongestDrain(2);
/// In simulated time, the node looks this often whether the deadline of a shape has passed.
constexpr std::chrono::milliseconds kShortestSimulatedWait(1);
/// If the node cannot keep up with its messages, shapes wait at most this much longer than
/// tf_timeout_sec for their transforms.
constexpr std::chrono::seconds kLongestBacklog(1);
/// After a breakdown, the node waits this long for its last messages to leave.
const ros::WallDuration kLastWords(1.0);

ros::NodeHandle on_queue(ros::NodeHandle node, ros::CallbackQueue& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

std::vector<Tool> load_tools(const std::vector<ToolParameters>& parameters,
                             const ros::NodeHandle& private_node) {
  std::vector<Tool> tools;
  for (const ToolParameters& of_tool : parameters) {
    tools.push_back(load_tool(of_tool, private_node));
  }
  return tools;
}

}  // namespace

CollisionNode::CollisionNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(on_queue(node, queue_)),
      private_node_(on_queue(private_node, queue_)),
      loaded_(load_parameters(private_node_)),
      tools_(load_tools(loaded_.parameters.tools, private_node_)),
      publisher_(private_node_, tools_, counters_),
      pipeline_(loaded_.parameters, tools_,
                {[this](const EvaluatedStep& step) { publisher_.publish(step); },
                 [this](const OrganUpdate& update) { publisher_.report(update); },
                 counters_.rejected, queue_}),
      services_({loaded_.parameters, tools_, pipeline_.organs(), pipeline_.transforms(),
                 pipeline_.poses(), pipeline_.steps().history(), pipeline_.contact_query(),
                 counters_.refused}),
      diagnostics_({loaded_.parameters, tools_, loaded_.misspelt, pipeline_.organs(),
                    pipeline_.contact_query(), pipeline_.steps(), pipeline_.transforms(),
                    counters_}),
      updater_(node_, private_node_, private_node_.getNamespace()) {
  for (const std::string& sentence : loaded_.misspelt) ROS_WARN("%s", sentence.c_str());
  for (const Tool& tool : tools_) {
    if (!tool.fault.empty()) ROS_ERROR("%s", tool.fault.c_str());
  }
  pipeline_.subscribe(node_, private_node_);
  services_.advertise(private_node_);
  reset_ = private_node_.advertiseService(names::kReset, &CollisionNode::on_reset, this);
  if (loaded_.parameters.rate_hz > 0.0) {
    tick_ = private_node_.createTimer(ros::Duration(1.0 / loaded_.parameters.rate_hz),
                                      [this](const ros::TimerEvent&) { pipeline_.add_tick(); });
  }
  diagnostics_.add_to(updater_);
  // The updater's own timer follows simulated time, and would stop when simulated time stops.
  diagnostic_timer_ = private_node_.createWallTimer(
      ros::WallDuration(loaded_.parameters.diagnostic_period_sec),
      [this](const ros::WallTimerEvent&) { updater_.force_update(); });
  ROS_INFO("ready: %zu tools, GL %s", tools_.size(),
           pipeline_.contact_query().gl_version().c_str());
}

void CollisionNode::run(const std::function<bool()>& stop) {
  try {
    while (private_node_.ok() && !stop()) {
      receive();
      pipeline_.evaluate(heard_until_);
    }
  } catch (const std::exception& error) {
    publisher_.report_breakdown(pipeline_.organs(), error.what());
    report_last_diagnostics();
    kLastWords.sleep();
    throw;
  }
}

/// Never throws, because the caller rethrows the exception that ends the node.
void CollisionNode::report_last_diagnostics() {
  try {
    updater_.force_update();
  } catch (const std::exception&) {  // Usually std::bad_alloc. There is nowhere left to report it.
  }
}

/// Waits for the first callback, but not beyond the deadline of a shape that waits for a transform.
/// Then calls all callbacks that are there, for at most kLongestDrain.
void CollisionNode::receive() {
  SteadyTime before = wait_clock_.now();
  bool called = call_one(wait(before));
  const SteadyTime end = SteadyClock::now() + kLongestDrain;
  while (called && SteadyClock::now() < end) {
    before = wait_clock_.now();
    called = call_one(ros::WallDuration(0.0));
  }
  // A transform may be among the callbacks that are left. The time that they take does not count.
  heard_until_ = called ? std::max(heard_until_, before - kLongestBacklog) : before;
  pipeline_.watch_clock();
}

/// How long to wait for the first callback.
ros::WallDuration CollisionNode::wait(SteadyTime now) const {
  std::chrono::nanoseconds wait = kLongestWait;
  if (const auto deadline = pipeline_.next_deadline()) wait = std::min(wait, *deadline - now);
  // Simulated time goes on in jumps, and no callback tells of them.
  const auto shortest = ros::Time::isSimTime() ? kShortestSimulatedWait : 0ms;
  return ros::WallDuration().fromNSec(std::max<std::chrono::nanoseconds>(wait, shortest).count());
}

/// Returns false if there was no callback.
bool CollisionNode::call_one(ros::WallDuration wait) {
  pipeline_.watch_clock();
  bool called = true;
  guard([&] { called = queue_.callOne(wait) == ros::CallbackQueue::Called; });
  guard([this] { pipeline_.apply_organ_messages(wait_clock_.now()); });
  return called;
}

/// Runs an action. If it throws, the exception is counted, and the node goes on.
void CollisionNode::guard(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {  // Usually std::bad_alloc.
    counters_.rejected.add("exception", error.what(), SteadyClock::now());
  }
}

bool CollisionNode::on_reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  pipeline_.reset();
  return true;
}

}  // namespace organ_collision
