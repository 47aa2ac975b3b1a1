#include "collision_node.hpp"

#include <algorithm>
#include <chrono>
#include <exception>

#include "organ_collision/ros/names.hpp"
#include "ros/interface/plain_text.hpp"
#include "ros/interface/plausible_size.hpp"

namespace organ_collision {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// The node waits at most this long for a callback, so that it notices a stop and a clock jump.
constexpr std::chrono::milliseconds kLongestWait(10);
/// The node calls callbacks for at most this long before it evaluates what they brought.
constexpr std::chrono::milliseconds kLongestDrain(2);
/// After a breakdown, the node waits this long for its last messages to leave.
const ros::WallDuration kLastWords(1.0);

ros::NodeHandle on_queue(ros::NodeHandle node, ros::CallbackQueue& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

MeshLimits limits(const NodeParameters& parameters) {
  return {static_cast<std::size_t>(parameters.max_faces)};
}

std::vector<Tool> load_tools(const std::vector<ToolParameters>& parameters,
                             const ros::NodeHandle& private_node) {
  std::vector<Tool> tools;
  for (const ToolParameters& of_tool : parameters) {
    tools.push_back(load_tool(of_tool, private_node));
  }
  return tools;
}

void warn_of_implausible_sizes(const std::vector<Tool>& tools) {
  for (const Tool& tool : tools) {
    if (!tool.parameters.has_shaft()) continue;
    const std::string doubt = doubt_about_radius(tool.parameters.name, tool.parameters.radius);
    if (!doubt.empty()) ROS_WARN("%s", doubt.c_str());
  }
}

PathSampling sampling(const NodeParameters& parameters) {
  return {parameters.motion_sample_sec, parameters.motion_samples_max};
}

}  // namespace

CollisionNode::CollisionNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(on_queue(node, queue_)),
      private_node_(on_queue(private_node, queue_)),
      loaded_(load_parameters(private_node_)),
      tools_(load_tools(loaded_.parameters.tools, private_node_)),
      organs_(limits(loaded_.parameters)),
      poses_(transforms_, sampling(loaded_.parameters)),
      contact_query_(loaded_.parameters.picker),
      publisher_(private_node_, tools_, counters_),
      steps_(loaded_.parameters, tools_, poses_, contact_query_,
             [this](const EvaluatedStep& step) { publisher_.publish(step); }),
      services_({loaded_.parameters, tools_, organs_, transforms_, poses_, steps_.history(),
                 contact_query_, counters_.refused}),
      diagnostics_({loaded_.parameters, tools_, loaded_.misspelt, organs_, contact_query_, steps_,
                    transforms_, counters_}),
      updater_(node_, private_node_, private_node_.getNamespace()),
      organ_topics_(organs_, counters_.rejected, queue_),
      surfaces_(background_.queue()),
      organ_services_({organs_, organ_topics_, queue_, background_.queue()}),
      transform_topics_(transforms_, counters_.rejected),
      pose_topics_(
          loaded_.parameters.tools,
          {transforms_, counters_.rejected, [this](std::size_t tool) { steps_.add_pose(tool); }}) {
  for (const std::string& sentence : loaded_.misspelt) ROS_WARN("%s", sentence.c_str());
  for (const Tool& tool : tools_) {
    if (!tool.fault.empty()) ROS_ERROR("%s", tool.fault.c_str());
  }
  warn_of_implausible_sizes(tools_);
  organ_topics_.subscribe(private_node_);
  transform_topics_.subscribe(node_);
  pose_topics_.subscribe(node_);
  services_.advertise(private_node_);
  organ_services_.advertise(private_node_);
  reset_ = private_node_.advertiseService(names::kReset, &CollisionNode::on_reset, this);
  if (loaded_.parameters.rate_hz > 0.0) {
    tick_ = private_node_.createTimer(ros::Duration(1.0 / loaded_.parameters.rate_hz),
                                      [this](const ros::TimerEvent&) { steps_.add_tick(); });
  }
  diagnostics_.add_to(updater_);
  // The updater's own timer follows simulated time, and would stop when simulated time stops.
  diagnostic_timer_ = private_node_.createWallTimer(
      ros::WallDuration(loaded_.parameters.diagnostic_period_sec),
      [this](const ros::WallTimerEvent&) { updater_.force_update(); });
  ROS_INFO("ready: %s, GL %s", counted(tools_.size(), "tool").c_str(),
           contact_query_.gl_version().c_str());
}

void CollisionNode::run(const std::function<bool()>& stop) {
  try {
    while (private_node_.ok() && !stop()) {
      receive();
      steps_.evaluate(organs_, SteadyClock::now());
      surfaces_.update(organs_, SteadyClock::now());
    }
  } catch (const std::exception& error) {
    publisher_.report_breakdown(organs_, error.what());
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
  SteadyClock::time_point until = SteadyClock::now() + kLongestWait;
  if (const auto deadline = steps_.next_deadline()) until = std::min(until, *deadline);
  const std::chrono::duration<double> wait = until - SteadyClock::now();

  bool called = call_one(ros::WallDuration(std::max(0.0, wait.count())));
  const SteadyClock::time_point end = SteadyClock::now() + kLongestDrain;
  while (called && SteadyClock::now() < end) called = call_one(ros::WallDuration(0.0));
  watch_clock();
}

/// Returns false if there was no callback.
bool CollisionNode::call_one(ros::WallDuration wait) {
  watch_clock();
  bool called = true;
  guard([&] { called = queue_.callOne(wait) == ros::CallbackQueue::Called; });
  guard([this] { apply_organ_messages(); });
  return called;
}

void CollisionNode::apply_organ_messages() {
  while (const auto update = organ_topics_.next()) {
    steps_.add(organs_, *update, SteadyClock::now());
    publisher_.report(*update);
  }
}

/// Runs an action. If it throws, the exception is counted, and the node goes on.
void CollisionNode::guard(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {  // Usually std::bad_alloc.
    counters_.rejected.add("exception", std::string("a message was dropped: ") + error.what(),
                           SteadyClock::now());
  }
}

/// Called before each callback, so that no message meets state from before a jump of the clock.
void CollisionNode::watch_clock() {
  const ros::Time now = ros::Time::now();
  if (now < last_now_) {
    ROS_WARN("the clock jumped back from %f to %f s: all history is forgotten", last_now_.toSec(),
             now.toSec());
    transforms_.clear();
    pose_topics_.forget_stamps();
    organs_.forget_previous_shapes();
    organs_.forget_connections();
    steps_.start_anew(organs_);
  }
  last_now_ = now;
}

bool CollisionNode::on_reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  organs_.forget_previous_shapes();
  organs_.forget_connections();
  steps_.reset();
  return true;
}

}  // namespace organ_collision
