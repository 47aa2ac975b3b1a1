#include "program.hpp"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <iostream>
#include <sstream>

namespace organ_collision {
namespace {

constexpr std::size_t kLineLength = 90;

/// The text, broken into lines that begin with `indent`.
std::string wrapped(const std::string& text, const std::string& indent) {
  std::istringstream words(text);
  std::string lines, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + word.size() >= kLineLength) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? indent : " ") + word;
  }
  return lines + line + "\n";
}

std::string section(const std::string& title, const std::vector<HelpEntry>& entries) {
  if (entries.empty()) return {};
  std::string text = "\n" + title + ":\n";
  for (const HelpEntry& entry : entries) {
    text += "  " + entry.name + " (" + entry.kind + ")\n" + wrapped(entry.text, "      ");
  }
  return text;
}

const ros::WallDuration kMasterPeriod(1.0);

// What is known of the ROS master.
constexpr char kListed[] = "listed";
constexpr char kNoAnswer[] =
    "the ROS master does not answer; nodes that are connected go on, and new ones cannot connect";
constexpr char kNotListed[] =
    "the ROS master does not list this node any more, as after a restart of the master: new nodes "
    "cannot connect to it. Restart the node";

constexpr char kNoClock[] =
    "use_sim_time is true, but no time has come on /clock: nothing that follows ROS time goes on. "
    "Start what publishes /clock, or set use_sim_time to false and restart the node";
/// [s] Other nodes may still be starting. Then, the log repeats that there is no time.
constexpr int kClockStart = 3, kClockRepetition = 10;

/// roscpp takes SIGINT only. A second signal ends the program at once.
void on_sigterm(int signal) {
  ros::requestShutdown();
  std::signal(signal, SIG_DFL);
}

constexpr char kParameters[] =
    "Parameters, private (~), with default and legal values; live: can change while the node runs";
constexpr char kToolKeys[] =
    "Keys of an entry of ~tools, with the tools that have them, and their defaults";

std::string help_text(const ProgramHelp& help) {
  return "Usage: rosrun organ_collision " + help.program + " [NAME:=VALUE ...]\n\n" +
         wrapped(help.purpose, "") + section("Subscribed topics", help.subscribed) +
         section("Published topics", help.published) + section("Services", help.services) +
         section(kParameters, help.parameters) + section(kToolKeys, help.tool_keys) +
         (help.further.empty() ? "" : "\n" + wrapped(help.further, ""));
}

}  // namespace

std::optional<int> answer_arguments(int argc, char** argv, const ProgramHelp& help) {
  ros::V_string arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (arguments.size() <= 1) return std::nullopt;
  for (const char* asks : {"--help", "-h"}) {
    if (std::find(arguments.begin() + 1, arguments.end(), asks) == arguments.end()) continue;
    if (std::cout << help_text(help) << std::flush) return 0;
    std::cerr << help.program << ": stdout cannot be written\n";
    return 1;
  }
  std::cerr << help.program << ": unknown argument '" << arguments[1]
            << "'; legal are --help, and ROS's NAME:=VALUE\n";
  return 2;
}

int run_program(int argc, char** argv, const ProgramHelp& help, const std::string& name,
                void (*run)(const ros::NodeHandle& node, const ros::NodeHandle& private_node),
                std::uint32_t options) {
  if (const auto exit_code = answer_arguments(argc, argv, help)) return *exit_code;
  ros::init(argc, argv, name, options);
  std::signal(SIGTERM, on_sigterm);
  const ros::NodeHandle node;  // Without any node handle, ROS_FATAL below would not reach /rosout.
  try {
    run(node, ros::NodeHandle("~"));
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}

void DiagnosticTasks::publish() {
  diagnostic_msgs::DiagnosticArray array;
  const boost::mutex::scoped_lock lock(lock_);
  for (const auto& task : getTasks()) {
    diagnostic_updater::DiagnosticStatusWrapper status;
    status.hardware_id = "none";
    task.run(status);
    status.name = name_.substr(1) + ": " + task.getName();
    array.status.push_back(status);
  }
  array.header.stamp = ros::Time::now();
  topic_.publish(array);
}

Diagnostics::Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         double period_sec)
    : tasks_(node, private_node.getNamespace()), master_(kListed) {
  tasks_.add("master", [this](auto& status) { diagnose_master(status); });
  tasks_.add("clock", [](auto& status) {
    const bool has_time = ros::Time::now() > ros::Time();
    status.summary(has_time ? 0 : 1, has_time ? "it goes" : kNoClock);
  });
  // A timer of ROS time would stop when simulated time stops.
  publish_ = private_node.createWallTimer(ros::WallDuration(period_sec),
                                          [this](const ros::WallTimerEvent&) { tasks_.publish(); });
  ask_ = on_queue(ros::NodeHandle(), asking_.queue())
             .createWallTimer(kMasterPeriod, [this](const ros::WallTimerEvent&) { ask_master(); });
}

/// Asks the master whether it lists this node, until a restart of the master is noticed. Later
/// answers would mislead: a topic that registers after the restart, such as that of a new tool,
/// makes the master list the node again, but without its older topics. Looks after the clock, too.
void Diagnostics::ask_master() {
  without_clock_ = ros::Time::now() > ros::Time() ? 0 : without_clock_ + 1;
  if (without_clock_ % kClockRepetition == kClockStart) ROS_WARN("%s", kNoClock);
  if (master_ == kNotListed) return;
  XmlRpc::XmlRpcValue arguments, response, uri;
  arguments[0] = arguments[1] = ros::this_node::getName();
  const bool is_listed = ros::master::execute("lookupNode", arguments, response, uri, false);
  if (ros::isShuttingDown()) return;
  master_ = is_listed ? kListed : response.valid() ? kNotListed : kNoAnswer;
  if (master_ == kNotListed) ROS_ERROR("%s", kNotListed);
}

void Diagnostics::diagnose_master(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  const char* const master = master_;
  const auto fault = master == kNotListed ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN;
  status.summary(master == kListed ? DiagnosticStatus::OK : fault, master);
}

}  // namespace organ_collision
