/// tool_guard: watches the answers of the collision node, and publishes how fast each tool may go
/// on. It only reads topics and lists, so that it does not depend on what it watches.

#include <diagnostic_msgs/DiagnosticArray.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/ListTools.h>
#include <ros/names.h>
#include <ros/ros.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <array>
#include <chrono>

#include "common/messages/checked_messages.hpp"
#include "common/messages/conversions.hpp"
#include "common/program/program.hpp"
#include "organ_collision/ros/names.hpp"
#include "tool_guard.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr char kProgram[] = "tool_guard", kState[] = "state";
/// [messages] Half a second of answers at 1 kHz about two organs. If more wait, some are lost,
/// which stops the tools.
constexpr std::uint32_t kAnswerQueue = 1000;
constexpr double kWatchPeriod = 0.02;  ///< [s] of states without answers
constexpr double kListPeriod = 0.5;    ///< [s] between two questions for organs and tools

/// scripts/make_reference makes doc/reference/nodes.md of it, and a test compares both.
ProgramHelp tool_guard_help() {
  ProgramHelp help{
      kProgram,
      "Watches the clearances, sides and contacts of the collision node, and says how fast each "
      "tool may go on. It is not a safety-rated function. The names below are private to the node "
      "(~), whose default name is /" +
          std::string(kProgram) + "."};
  help.subscribed = {
      {ros::names::append(names::kNode, names::kContacts), message_type<ContactArray>(),
       "the answers. The parameter collision_node replaces organ_collision. The services "
       "list_organs and list_tools of the same node are asked twice a second"},
      {"/tf, /tf_static", message_type<tf2_msgs::TFMessage>(),
       "where trocar and tip are: the way out of tissue that a shaft pierces"}};
  help.published = {
      {kState, message_type<GuardState>(),
       "how fast a tool may go on, and why: at each answer about the tool, and 50 times a second "
       "without answers"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "for each tool its stage, its reason and the states that were sent; lost and unreadable "
       "answers; names in keep and touch_allowed that no organ has"}};
  help.services = {LiveParameters::help()};
  help.parameters = parameter_help<GuardParameters>();
  help.further =
      "roslaunch organ_collision tool_guard.launch starts it beside a collision node. "
      "doc/guard.md explains what it guarantees, and what it does not.";
  return help;
}

GuardTime present() {
  const auto steady = std::chrono::steady_clock::now().time_since_epoch();
  return {std::chrono::duration<double>(steady).count(), ros::Time::now()};
}

/// The node. Its queue's callbacks are called in the thread that spins, which never waits for
/// another node: the lists are asked for in a thread of their own.
class GuardNode {
 public:
  /// Throws ParameterError.
  GuardNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
      : node_(on_queue(node, queue_)),
        private_node_(on_queue(private_node, queue_)),
        table_(load_parameters(parameters_, private_node)),
        transforms_listener_(transforms_, node),
        collision_node_(node_.resolveName(parameters_.collision_node)),
        diagnostics_(node_, private_node_, parameters_.diagnostic_period_sec),
        live_parameters_(on_queue(private_node, background_.queue()), table_,
                         [this](const auto& changes) {
                           run_in_thread_of(queue_, [&] { table_.change(changes); });
                         }) {
    for (const std::string& sentence : parameters_.misspelt) ROS_WARN("%s", sentence.c_str());
    for (const std::string& tool : parameters_.tools) guard_of(tool);
    states_ = private_node_.advertise<GuardState>(kState, 100);
    answers_ = subscribe_checked<ContactArray>(
        node_, ros::names::append(collision_node_, names::kContacts), kAnswerQueue,
        [this](const auto& event) { take(event); }, rejected_);
    diagnostics_.updater().add("tools", this, &GuardNode::diagnose);
    live_parameters_.advertise();
    watch_ = node_.createWallTimer(ros::WallDuration(kWatchPeriod),
                                   [this](const ros::WallTimerEvent&) { watch(); });
    ask_ = on_queue(node, polling_.queue())
               .createWallTimer(ros::WallDuration(kListPeriod),
                                [this](const ros::WallTimerEvent&) { ask(); });
  }
  GuardNode(const GuardNode&) = delete;
  GuardNode& operator=(const GuardNode&) = delete;
  ~GuardNode() {
    queue_.disable();
    queue_.clear();
  }

  /// Throws ParameterError if a tool of the collision node lacks what the guard needs.
  void spin() {
    while (ros::ok()) queue_.callAvailable(ros::WallDuration(0.1));
  }

 private:
  struct Guarded {
    ToolGuard guard;
    double sent = 0.0;                      ///< [s] when the last state was sent
    GuardState last = {};                   ///< and which
    std::array<std::uint64_t, 3> stages{};  ///< how many states were sent, by stage
  };

  Guarded& guard_of(const std::string& name) {
    ToolInfo info;
    info.name = name;
    return tools_.try_emplace(name, Guarded{ToolGuard(parameters_, info)}).first->second;
  }

  void take(const ros::MessageEvent<const ContactArray>& event) {
    const ContactArray::ConstPtr& answer = event.getConstMessage();
    const auto tool = tools_.find(answer->tool);
    const GuardTime now = present();
    if (tool != tools_.end()) tool->second.guard.take(answer, outward(*answer, tool->second), now);
    // roscpp numbers the messages of a publisher. A restarted one begins anew.
    const std::string sender = event.getPublisherName();
    if (sender == sender_ && answer->header.seq > seq_ + 1) {
      lost_ += answer->header.seq - seq_ - 1;
      for (auto& [name, guarded] : tools_) guarded.guard.lose_answers();
    }
    sender_ = sender;
    seq_ = answer->header.seq;
    if (tool != tools_.end()) send(tool->second, now);
  }

  void watch() {
    const GuardTime now = present();
    for (auto& [name, guarded] : tools_) {
      if (now.steady - guarded.sent > 0.5 * kWatchPeriod) send(guarded, now);
    }
  }

  void send(Guarded& guarded, GuardTime now) {
    guarded.last = guarded.guard.decide(now);
    guarded.sent = now.steady;
    states_.publish(guarded.last);
    ++guarded.stages.at(guarded.last.stage);
    if (guarded.last.stage != GuardState::STOP) return;
    stops_.add(guarded.last.tool, "tool '" + guarded.last.tool + "' stops: " + guarded.last.reason);
  }

  /// From the tip of a shaft to its trocar, if the way out of the organ may need it.
  Vector3d outward(const ContactArray& answer, const Guarded& guarded) const {
    const ToolInfo& tool = guarded.guard.tool();
    const ToolPlacement& placement = answer.placement;
    if (placement.tip == ToolPlacement::OUTSIDE && placement.crossings.empty()) return {0, 0, 0};
    if (tool.trocar_frame.empty() || tool.tip_frame.empty()) return {0, 0, 0};
    const auto place = [&](const std::string& frame, const geometry_msgs::Vector3& offset) {
      return Vector3d(to_eigen(transforms_
                                   .lookupTransform(tf_frame(answer.header.frame_id),
                                                    tf_frame(frame), answer.header.stamp)
                                   .transform) *
                      to_eigen(offset));
    };
    try {
      const Vector3d axis =
          place(tool.trocar_frame, tool.trocar_offset) - place(tool.tip_frame, tool.tip_offset);
      return axis.isZero(0.0) ? axis : axis.normalized();
    } catch (const tf2::TransformException&) {
      return {0, 0, 0};
    }
  }

  /// Asks for the lists, in a thread of its own, because the answers may take long or never come.
  void ask() {
    const ros::NodeHandle node(collision_node_);
    if (!list_tools_.isValid()) {
      list_tools_ = ros::NodeHandle(node).serviceClient<ListTools>(names::kListTools, true);
    }
    if (!list_organs_.isValid()) {
      list_organs_ = ros::NodeHandle(node).serviceClient<ListOrgans>(names::kListOrgans, true);
    }
    const double asked = present().steady;
    ListTools tools;
    ListOrgans organs;
    if (!list_tools_.call(tools) || !list_organs_.call(organs)) return;
    bool has_placement = true;
    if (!is_checked_) node.getParam("publish_placement", has_placement);
    call_later(queue_, [this, tools, organs, asked, has_placement] {
      if (!is_checked_) check(tools.response.tools, has_placement);
      is_checked_ = true;
      take(tools.response.tools, organs.response.organs, asked);
    });
  }

  /// Throws ParameterError if the guard cannot watch the tools.
  void check(const std::vector<ToolInfo>& tools, bool has_placement) const {
    std::vector<std::string> names, links{kShaftName};
    for (const ToolInfo& tool : tools) {
      names.push_back(tool.name);
      links.insert(links.end(), tool.links.begin(), tool.links.end());
      const std::string missing = ToolGuard::missing_in(tool);
      if (!is_guarded(tool.name) || missing.empty()) continue;
      throw ParameterError(collision_node_ + "/tools: '" + tool.name + "' " + missing);
    }
    if (names.empty()) throw ParameterError(collision_node_ + "/tools is empty");
    if (!has_placement) {
      throw ParameterError(collision_node_ +
                           "/publish_placement is false, so that no tool's side is known");
    }
    const auto require = [](const std::string& parameter, const std::string& name,
                            const std::vector<std::string>& legal) {
      if (std::find(legal.begin(), legal.end(), name) != legal.end()) return;
      throw ParameterError(parameter + " has '" + name + "'; nearest is '" +
                           nearest_name(name, legal) + "', legal are " + listed(legal));
    };
    for (const std::string& tool : parameters_.tools) require("~tools", tool, names);
    for (const auto& [organ, link] : parameters_.touch_allowed) {
      require("~touch_allowed", link, links);
    }
  }

  bool is_guarded(const std::string& tool) const {
    return parameters_.tools.empty() || tools_.count(tool) > 0;
  }

  void take(const std::vector<ToolInfo>& tools, const std::vector<OrganInfo>& organs,
            double asked) {
    for (const ToolInfo& tool : tools) {
      if (is_guarded(tool.name)) guard_of(tool.name).guard.set_tool(tool);
    }
    for (auto& [name, guarded] : tools_) guarded.guard.set_organs(organs, asked);
    std::vector<std::string> legal;
    for (const OrganInfo& organ : organs) legal.push_back(organ.name);
    unknown_.clear();
    const auto look = [&](const char* parameter, const std::string& organ) {
      if (legal.empty() || std::find(legal.begin(), legal.end(), organ) != legal.end()) return;
      unknown_.push_back(std::string(parameter) + " has the organ '" + organ +
                         "', which the collision node has not; nearest is '" +
                         nearest_name(organ, legal) + "'");
    };
    for (const auto& [organ, side] : parameters_.keep) look("~keep", organ);
    for (const auto& [organ, link] : parameters_.touch_allowed) look("~touch_allowed", organ);
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    using diagnostic_msgs::DiagnosticStatus;
    status.summary(DiagnosticStatus::OK, "watching");
    if (!is_checked_) status.summary(DiagnosticStatus::WARN, collision_node_ + " has not answered");
    for (const auto& [name, guarded] : tools_) {
      const auto& stages = guarded.stages;
      status.add(name + ", states CLEAR, SLOW, STOP", std::to_string(stages[0]) + ", " +
                                                          std::to_string(stages[1]) + ", " +
                                                          std::to_string(stages[2]));
      status.add(name + ", speed_scale", guarded.last.speed_scale);
      if (guarded.last.stage != GuardState::STOP) continue;
      status.mergeSummary(DiagnosticStatus::WARN, "tool '" + name + "': " + guarded.last.reason);
    }
    status.add("lost answers", lost_);
    for (const std::string& sentence : unknown_) {
      status.mergeSummary(DiagnosticStatus::WARN, sentence);
    }
    for (const std::string& sentence : parameters_.misspelt) {
      status.mergeSummary(DiagnosticStatus::WARN, sentence);
    }
    show_failures("rejected", rejected_, status);
  }

  ros::CallbackQueue queue_;
  QueueThread background_, polling_;
  ros::NodeHandle node_, private_node_;
  GuardParameters parameters_;
  const ParameterTable table_;
  tf2_ros::Buffer transforms_;
  const tf2_ros::TransformListener transforms_listener_;
  const std::string collision_node_;
  FailureLog rejected_, stops_;
  std::map<std::string, Guarded> tools_;
  std::vector<std::string> unknown_;  ///< sentences about names of organs
  std::atomic<bool> is_checked_{false};
  std::string sender_;      ///< of the last answer
  std::uint32_t seq_ = 0;   ///< its number
  std::uint64_t lost_ = 0;  ///< answers
  ros::Publisher states_;
  ros::Subscriber answers_;
  ros::ServiceClient list_tools_, list_organs_;  ///< of the thread that asks
  ros::WallTimer watch_, ask_;
  Diagnostics diagnostics_;
  LiveParameters live_parameters_;
};

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  return run_program(argc, argv, tool_guard_help(), kProgram,
                     [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                       GuardNode(node, private_node).spin();
                     });
}
