#include "node_core.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/RemoveOrgan.h>
#include <ros/console.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <chrono>

#include "common/messages/robot_reply.hpp"
#include "common/messages/text.hpp"
#include "organ_collision/ros/names.hpp"

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

/// How long to wait for the first callback.
ros::WallDuration wait_until(std::optional<SteadyTime> deadline, SteadyTime now) {
  std::chrono::nanoseconds wait = kLongestWait;
  if (deadline) wait = std::min<std::chrono::nanoseconds>(wait, *deadline - now);
  // Simulated time advances in jumps, and no callback tells of them. The node must look for them:
  // `shortest` is the pause between two looks.
  const auto shortest = ros::Time::isSimTime() ? kShortestSimulatedWait : 0ms;
  return ros::WallDuration().fromNSec(std::max<std::chrono::nanoseconds>(wait, shortest).count());
}

/// Logs what is doubtful about the parameters of a node: unknown names, tools that do not work, and
/// implausible sizes.
void warn_of_settings(const std::vector<Tool>& tools, const std::vector<std::string>& misspelt) {
  for (const std::string& sentence : misspelt) ROS_WARN("%s", sentence.c_str());
  if (tools.empty()) ROS_WARN("%s", kNoTools);
  for (const Tool& tool : tools) {
    if (!tool.fault.empty()) ROS_ERROR("%s", tool.fault.c_str());
    for (const std::string& doubt : doubts(tool)) ROS_WARN("%s", doubt.c_str());
  }
}

}  // namespace

void MessageLoop::receive(OrganNode& node, std::optional<SteadyTime> deadline) {
  SteadyTime before = clock_.now();
  bool called = call_one(node, wait_until(deadline, before));
  const SteadyTime end = SteadyClock::now() + kLongestDrain;
  while (called && SteadyClock::now() < end) {
    before = clock_.now();
    called = call_one(node, ros::WallDuration(0.0));
  }
  // If callbacks are left, a transform may be among them. heard_until_ then stays as it is, so that
  // no shape misses its transform, but it stays at most kLongestBacklog behind.
  heard_until_ = called ? std::max(heard_until_, before - kLongestBacklog) : before;
}

/// Calls one callback, and the node's own functions around it. Returns false if there was none.
bool MessageLoop::call_one(OrganNode& node, ros::WallDuration wait) {
  const auto handle = [&] {
    node.its_inbox().watch_clock();
    node.handle(clock_.now());
  };
  handle();
  const bool called = queue_.callOne(wait) == ros::CallbackQueue::Called;
  handle();
  return called;
}

void MessageLoop::end() {
  queue_.disable();
  queue_.clear();
}

ProgramHelp organ_node_help(const std::string& program, const std::string& purpose,
                            const std::string& reset) {
  ProgramHelp help{program, purpose};
  help.subscribed = {
      {names::kOrganMesh, message_type<OrganMesh>(),
       "the surface of an organ: send it when the organ appears and whenever its triangles change, "
       "latched if possible. A mesh without vertices and triangles removes the organ"},
      {names::kOrganVertices, message_type<OrganVertices>(),
       "the new shape of an organ. If several wait, only the newest one counts"},
      {"/tf, /tf_static", message_type<tf2_msgs::TFMessage>(), "where the tools and organs are"},
      {"as each tool names it", message_type<geometry_msgs::PoseStamped>(),
       "where the tool's tip is (tip_pose_topic), or the frame of its poses (base_pose_topic)"}};
  help.services = {
      {names::kListOrgans, service_type<ListOrgans>(),
       "all organs that have a mesh, sorted by name: frame, topology, numbers of faces and "
       "vertices, closed or not, and box, volume and stamp of the latest shape. Waits until a new "
       "mesh is inspected; steps do not wait for it"},
      {names::kRemoveOrgan, service_type<RemoveOrgan>(),
       "removes an organ, as a mesh without vertices and triangles does. If there is no such "
       "organ, success is false, and message says why"},
      {names::kListTools, service_type<ListTools>(),
       "all tools as they were loaded: frames, links, jaws, radius, and why one cannot be used"},
      {names::kReset, service_type<std_srvs::Empty>(), reset},
      {names::kReloadTools, service_type<std_srvs::Trigger>(),
       "reads the parameter tools again, and the robots' files; of haptic_proxy, clearance and "
       "keep, too. The message says what was read. Unchanged tools go on as before. If a list is "
       "illegal or a new tool cannot be loaded, nothing changes"},
      LiveParameters::help()};
  help.tool_keys = tool_keys();
  return help;
}

NodeCore::NodeCore(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                   OrganNodeParameters& parameters, const ParameterTable& table)
    : node_(on_queue(node, loop_.queue())),
      private_node_(on_queue(private_node, loop_.queue())),
      parameters_(parameters),
      table_(table),
      realtime_(parameters.realtime),
      tools_(load_tools(parameters.tools, private_node_)),
      diagnostics_(node_, private_node_, parameters.diagnostic_period_sec),
      live_parameters_(on_queue(private_node, background_), table_, [this](const auto& changes) {
        in_node_thread([&] {
          table_.change(changes);
          running_->parameters_changed();
        });
      }) {
  number_histories(tools_, KeptTools(tools_.size()));
}

void NodeCore::run(OrganNode& node, const RunControl& control) {
  try {
    start(node);
    control.ready();
    try {
      std::optional<SteadyTime> deadline;
      while (private_node_.ok() && !control.stop) {
        loop_.receive(node, deadline);
        if (broken_) std::rethrow_exception(broken_);
        deadline = node.work();
      }
    } catch (const std::exception& fault) {
      say_last_words(fault);
      throw;
    }
    node.end(nullptr);
  } catch (...) {
    end_threads();
    throw;
  }
  end_threads();
}

void NodeCore::start(OrganNode& node) {
  running_ = &node;
  warn_of_settings(tools_, parameters_.misspelt);
  diagnostics().add("scheduling", &realtime_, &Realtime::diagnose);
  live_parameters_.advertise();
  using std_srvs::Empty, std_srvs::Trigger;
  const auto on_reload = [this](auto&, auto& response) {
    reload(response);
    return true;
  };
  const auto on_reset = [&node](auto&, auto&) {
    node.its_inbox().begin_history("reset");
    return true;
  };
  const auto on_list = [this](auto&, auto& response) {
    for (const Tool& tool : tools_) response.tools.push_back(info_of(tool));
    return true;
  };
  servers_ = {
      on_queue(private_node_, background_)
          .advertiseService<Trigger::Request, Trigger::Response>(names::kReloadTools, on_reload),
      private_node_.advertiseService<Empty::Request, Empty::Response>(names::kReset, on_reset),
      private_node_.advertiseService<ListTools::Request, ListTools::Response>(names::kListTools,
                                                                              on_list)};
  node.start();
}

/// Releases the threads that wait for the node's thread, and waits until all of them have ended.
void NodeCore::end_threads() {
  loop_.end();
  for (QueueThread& thread : threads_) thread.stop();
}

/// A tool that is kept keeps the number of its history.
void NodeCore::number_histories(std::vector<Tool>& tools, const KeptTools& kept) {
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    tools[tool].history = kept[tool] ? tools_[*kept[tool]].history : ++tool_histories_;
  }
}

/// Runs in the background thread, because robots' files may take seconds to load.
void NodeCore::reload(std_srvs::Trigger::Response& response) {
  try {
    const XmlRpc::XmlRpcValue values = all_parameters(private_node_);
    const ParameterGroup all = table_.group(values);
    std::vector<std::string> misspelt = all.misspelt();
    std::vector<ToolParameters> parameters = parse_tools(all);
    std::vector<Tool> tools = load_tools(parameters, private_node_);
    ToolChanges changes = compare_tools(tools_, tools);
    for (std::size_t tool = 0; tool < tools.size(); ++tool) {  // An unchanged one keeps its fault.
      const bool is_refused = !changes.kept[tool] && !tools[tool].fault.empty();
      if (is_refused) throw ToolError(tools[tool].fault);
    }
    in_node_thread([&] {  // Before a tool is released: a list may be refused.
      const std::vector<std::string> lists = table_.read_lists(values);
      for (const std::string& list : lists) changes.summary += "; " + list;
      if (!lists.empty()) running_->parameters_changed();
    });
    number_histories(tools, changes.kept);
    const std::function<void()> take_over = running_->prepare_tools(tools, changes.kept);
    live_parameters_.publish();
    in_node_thread([&] { exchange_tools(tools, parameters, misspelt, take_over); });
    response.success = true;
    response.message = plain_text(changes.summary, kLongestMessage);
    ROS_INFO("tools are reloaded: %s", response.message.c_str());
  } catch (const std::exception& error) {
    response.message = plain_text(error.what(), kLongestMessage);
    ROS_WARN("tools stay as they were: %s", response.message.c_str());
  }
}

void NodeCore::exchange_tools(std::vector<Tool>& tools, std::vector<ToolParameters>& parameters,
                              std::vector<std::string>& misspelt,
                              const std::function<void()>& take_over) {
  try {
    tools_.swap(tools);
    parameters_.misspelt.swap(misspelt);
    parameters_.tools.swap(parameters);
    take_over();
    warn_of_settings(tools_, parameters_.misspelt);
  } catch (...) {
    broken_ = std::current_exception();
    throw;
  }
}

/// Lets the node tell its subscribers why it ends.
void NodeCore::say_last_words(const std::exception& fault) {
  try {
    running_->end(&fault);
    diagnostics().publish();
  } catch (const std::exception&) {  // The exception that ends the node is more important.
  }
  ros::WallDuration(1.0).sleep();  // Time for the last messages to be sent.
}

}  // namespace organ_collision
