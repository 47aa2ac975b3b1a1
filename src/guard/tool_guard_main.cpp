/// tool_guard: watches the answers of the collision node, and publishes how fast each tool may go
/// on. It only reads topics and lists, so that it does not depend on what it watches.

#include <diagnostic_msgs/DiagnosticArray.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/ListTools.h>
#include <ros/names.h>
#include <ros/ros.h>
#include <tf2/buffer_core.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include <chrono>
#include <set>
#include <utility>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "common/program/program.hpp"
#include "geometry/concatenate.hpp"
#include "organ_collision/ros/names.hpp"
#include "tool_guard.hpp"

namespace organ_collision {
namespace {

constexpr char kProgram[] = "tool_guard", kState[] = "state";
/// [messages] Half a second of answers at 1 kHz about two organs. If more wait, some are lost,
/// which stops the tools.
constexpr std::uint32_t kAnswerQueue = 1000;
constexpr double kWatchPeriod = 0.005;   ///< [s] between two looks whether a state is due
constexpr double kLongestWait = 0.0175;  ///< [s] after which it is: 50 times a second
constexpr double kListPeriod = 0.5;      ///< [s] between two questions for organs and tools
constexpr std::uint32_t kFewNear = 8;    ///< a smaller max_near hides tissue that comes fast

/// scripts/make_reference makes doc/reference/nodes.md of it, and a test compares both.
ProgramHelp tool_guard_help() {
  ProgramHelp help{
      kProgram,
      "Watches the clearances, sides and contacts of the collision node, and says how fast each "
      "tool may go on. It is not a safety-rated function. The names below are private (~)."};
  help.subscribed = {
      {ros::names::append(names::kNode, names::kContacts), message_type<ContactArray>(),
       "the answers. The parameter collision_node replaces organ_collision. Its services "
       "list_organs and list_tools are asked twice a second"},
      {"/tf, /tf_static", message_type<tf2_msgs::TFMessage>(),
       "where trocar and tip are: the way out of tissue that a shaft pierces"}};
  help.published = {
      {kState, message_type<GuardState>(),
       "how fast a tool may go on, and why: at each answer about it, and without answers 50 times "
       "a second"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "for each tool its speed_scale, and why it stops; lost answers; names in keep and "
       "touch_allowed that no organ has"}};
  help.services = {LiveParameters::help()};
  help.parameters = parameter_help<GuardParameters>();
  help.further = "doc/guard.md explains what it guarantees, and what it does not.";
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
        collision_node_(node_.resolveName(parameters_.collision_node)),
        diagnostics_(node_, private_node_, parameters_.diagnostic_period_sec),
        live_parameters_(on_queue(private_node, background_.queue()), table_,
                         [this](const auto& changes) {
                           run_in_thread_of(queue_, [&] { table_.change(changes); });
                         }) {
    for (const std::string& sentence : parameters_.misspelt) ROS_WARN("%s", sentence.c_str());
    for (const std::string& tool : parameters_.tools) {
      ToolInfo info;
      info.name = tool;
      tools_.try_emplace(tool, parameters_, info);
    }
    states_ = private_node_.advertise<GuardState>(kState, 100);
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    answers_ = node_.subscribe<ContactArray, const Answer&>(
        ros::names::append(collision_node_, names::kContacts), kAnswerQueue,
        [this](const Answer& answer) { take(answer); }, {}, hints);
    for (const bool resting : {false, true}) {
      tf_.push_back(node_.subscribe<tf2_msgs::TFMessage>(
          resting ? "/tf_static" : "/tf", kAnswerQueue,
          [this, resting](const auto& message) { take(*message, resting); }, {}, hints));
    }
    diagnostics_.tasks().add("tools", this, &GuardNode::diagnose);
    live_parameters_.advertise();
    watch_ = node_.createWallTimer(ros::WallDuration(kWatchPeriod), [this](const auto&) {
      const GuardTime now = present();
      for (auto& [name, tool] : tools_) {
        if (now.steady - tool.sent > kLongestWait) send(tool, now);
      }
    });
    ask_ = on_queue(node, polling_.queue())
               .createWallTimer(ros::WallDuration(kListPeriod), [this](const auto&) { ask(); });
  }
  ~GuardNode() {
    queue_.disable();
    queue_.clear();
  }

  /// Throws ParameterError if a tool of the collision node lacks what the guard needs.
  void spin() {
    while (ros::ok()) queue_.callAvailable(ros::WallDuration(0.1));
  }

 private:
  struct Guarded : ToolGuard {
    using ToolGuard::ToolGuard;
    double sent = 0.0;     ///< [s] when the last state was sent
    GuardState last = {};  ///< and which
  };

  using Answer = ros::MessageEvent<const ContactArray>;

  void take(const Answer& event) {
    const ContactArray::ConstPtr& answer = event.getConstMessage();
    const auto tool = tools_.find(answer->tool);
    const GuardTime now = present();
    if (tool != tools_.end()) {
      tool->second.take(answer, outward(*answer, tool->second.tool()), now);
    }
    // roscpp numbers the messages of a publisher. A restarted one begins anew.
    const std::uint32_t number = answer->header.seq;
    std::uint32_t& last = numbers_.try_emplace(event.getPublisherName(), number).first->second;
    if (number > last + 1) {
      lost_ += number - last - 1;
      for (auto& [name, guarded] : tools_) guarded.lose_answers();
    }
    last = number;
    if (tool != tools_.end()) send(tool->second, now);
  }

  /// This is not tf2_ros::TransformListener, which ends the process if the clock jumps back from
  /// beyond 2^31 s.
  void take(const tf2_msgs::TFMessage& message, bool resting) {
    const ros::Time now = ros::Time::now();
    if (now < std::exchange(transformed_, now)) transforms_.clear();
    for (const geometry_msgs::TransformStamped& transform : message.transforms) {
      try {
        transforms_.setTransform(transform, kProgram, resting);
      } catch (const std::runtime_error& error) {  // from ros::Time, for extreme stamps
        rejected_.add("transform", error.what());
      }
    }
  }

  void send(Guarded& tool, GuardTime now) {
    tool.last = tool.decide(now);
    tool.sent = now.steady;
    states_.publish(tool.last);
    if (tool.last.stage != GuardState::STOP) return;
    stops_.add(tool.last.tool, "tool '" + tool.last.tool + "' stops: " + tool.last.reason);
  }

  /// From the tip of a shaft to its trocar, if the way out of the organ may need it. The latest
  /// transforms serve, because those of the answer's stamp may come after the answer.
  Eigen::Vector3d outward(const ContactArray& answer, const ToolInfo& tool) const {
    const ToolPlacement& placement = answer.placement;
    if (placement.tip == ToolPlacement::OUTSIDE && placement.crossings.empty()) return {0, 0, 0};
    const auto place = [&](const std::string& frame, const geometry_msgs::Vector3& offset) {
      const auto found = transforms_.lookupTransform(tf_frame(answer.header.frame_id),
                                                     tf_frame(frame), ros::Time(0));
      const double age = seconds_between(found.header.stamp, answer.header.stamp);
      const bool moves = !found.header.stamp.isZero();
      if (moves && age > parameters_.longest_age()) throw tf2::ExtrapolationException("old");
      return Eigen::Vector3d(to_eigen(found.transform) * to_eigen(offset));
    };
    try {
      return (place(tool.trocar_frame, tool.trocar_offset) - place(tool.tip_frame, tool.tip_offset))
          .normalized();
    } catch (const std::runtime_error&) {  // also if the tool has no such frame
      return {0, 0, 0};
    }
  }

  /// Asks for the lists, in a thread of its own, because the answers may take long or never come.
  void ask() {
    const double asked = present().steady;
    const ros::NodeHandle node(collision_node_);
    ListTools tools;
    ListOrgans organs;
    if (!ros::service::call(node.resolveName(names::kListTools), tools) ||
        !ros::service::call(node.resolveName(names::kListOrgans), organs)) {
      return;
    }
    const bool has_placement = node.param("publish_placement", true);
    call_later(queue_, [=, tools = tools.response.tools, organs = organs.response.organs] {
      take(tools, organs, asked, has_placement);
    });
  }

  void take(const std::vector<ToolInfo>& tools, const std::vector<OrganInfo>& organs, double asked,
            bool has_placement) {
    if (!is_checked_) check(tools, has_placement);
    is_checked_ = true;
    few_near_.clear();
    for (const ToolInfo& tool : tools) {
      if (!is_guarded(tool)) continue;
      note_few_near(tool);
      tools_.try_emplace(tool.name, parameters_, tool).first->second.set_tool(tool);
    }
    for (auto& [name, tool] : tools_) tool.set_organs(organs, asked);
    std::vector<std::string> legal;
    for (const OrganInfo& organ : organs) legal.push_back(organ.name);
    unknown_.clear();
    for (const auto& [organ, side] : parameters_.keep) note_unknown("~keep", organ, legal);
    for (const auto& [organ, link] : parameters_.touch_allowed) {
      note_unknown("~touch_allowed", organ, legal);
    }
  }

  void note_few_near(const ToolInfo& tool) {
    if (tool.max_near >= kFewNear) return;
    few_near_.push_back(concatenate(collision_node_, "/tools: '", tool.name, "' has max_near ",
                                    tool.max_near, "; give it ", kFewNear,
                                    " or more, so that the guard sees how fast tissue comes"));
    if (few_near_known_.insert(few_near_.back()).second) ROS_WARN("%s", few_near_.back().c_str());
  }

  /// Throws ParameterError if the guard cannot watch the tools.
  void check(const std::vector<ToolInfo>& tools, bool has_placement) {
    std::vector<std::string> names, links{names::kShaftName};
    for (const ToolInfo& tool : tools) {
      names.push_back(tool.name);
      links.insert(links.end(), tool.links.begin(), tool.links.end());
      const std::string missing = is_guarded(tool) ? ToolGuard::missing_in(tool, parameters_) : "";
      if (missing.empty()) continue;
      throw ParameterError(collision_node_ + "/tools: '" + tool.name + "' " + missing);
    }
    if (tools.empty()) throw ParameterError(collision_node_ + "/tools is empty");
    if (!has_placement) {
      throw ParameterError(collision_node_ + "/publish_placement is false; it must be true");
    }
    for (const std::string& tool : parameters_.tools) note_unknown("~tools", tool, names);
    for (const auto& [organ, link] : parameters_.touch_allowed) {
      note_unknown("~touch_allowed", link, links);
    }
    if (!unknown_.empty()) throw ParameterError(unknown_[0]);
  }

  bool is_guarded(const ToolInfo& tool) const {
    return parameters_.tools.empty() || tools_.count(tool.name) > 0;
  }

  void note_unknown(const std::string& parameter, const std::string& name,
                    const std::vector<std::string>& legal) {
    if (legal.empty() || std::count(legal.begin(), legal.end(), name) > 0) return;
    unknown_.push_back(parameter + " has '" + name + "'; " + suggestion(name, legal));
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    status.summary(is_checked_ ? 0 : 1, is_checked_ ? "watching" : collision_node_ + " is silent");
    for (const auto& [name, tool] : tools_) {
      status.add(name + ", speed_scale", tool.last.speed_scale);
      if (tool.last.stage == GuardState::STOP)
        status.mergeSummary(1, name + ": " + tool.last.reason);
    }
    status.add("lost answers", lost_);
    for (const std::string& sentence : unknown_) status.mergeSummary(1, sentence);
    for (const std::string& sentence : few_near_) status.mergeSummary(1, sentence);
    for (const std::string& sentence : parameters_.misspelt) status.mergeSummary(1, sentence);
    show_failures("rejected", rejected_, status);
  }

  ros::CallbackQueue queue_;
  QueueThread background_, polling_;
  ros::NodeHandle node_, private_node_;
  GuardParameters parameters_;
  const ParameterTable table_;
  tf2::BufferCore transforms_;
  ros::Time transformed_;  ///< when the last transform came
  const std::string collision_node_;
  FailureLog rejected_, stops_;
  std::map<std::string, Guarded> tools_;
  std::vector<std::string> unknown_;   ///< sentences about unknown names
  std::vector<std::string> few_near_;  ///< sentences about tools with few near faces
  std::set<std::string> few_near_known_;
  bool is_checked_ = false;
  std::map<std::string, std::uint32_t> numbers_;  ///< of the last answers, by sender
  std::uint64_t lost_ = 0;                        ///< answers
  ros::Publisher states_;
  ros::Subscriber answers_;
  std::vector<ros::Subscriber> tf_;
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
