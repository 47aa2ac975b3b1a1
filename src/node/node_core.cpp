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
#include <exception>

#include "common/messages/conversions.hpp"
#include "common/messages/robot_reply.hpp"

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
       "all tools as they were loaded: frames, links, radius, and why one cannot be used"},
      {names::kReset, service_type<std_srvs::Empty>(), reset},
      {names::kReloadTools, service_type<std_srvs::Trigger>(),
       "reads the parameter tools again, and the robots' files. Unchanged tools go on as "
       "before. If the list is illegal or a new tool cannot be loaded, nothing changes"},
      LiveParameters::help()};
  help.tool_keys = tool_keys();
  return help;
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
