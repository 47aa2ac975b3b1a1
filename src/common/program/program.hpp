#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/message_traits.h>
#include <ros/node_handle.h>
#include <ros/service_traits.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/parameters/parameter_table.hpp"
#include "common/threads/queues.hpp"

namespace organ_collision {

/// What --help prints about a ROS program.
struct ProgramHelp {
  std::string program;
  std::string purpose;
  std::vector<HelpEntry> subscribed = {};
  std::vector<HelpEntry> published = {};
  std::vector<HelpEntry> services = {};
  std::vector<HelpEntry> parameters = {};
  std::vector<HelpEntry> tool_keys = {};
  std::string further = {};  ///< how to start the program, or where to read on
};

/// What a node and the program or nodelet that runs it tell each other.
struct RunControl {
  std::atomic<bool> stop{false};        ///< set it, in any thread, to end the node
  std::function<void()> ready = [] {};  ///< the node calls it when it works
};

/// Prints the help for --help and -h. Prints one line on standard error for any other argument that
/// is not for ROS, such as NAME:=VALUE is. Returns the exit code, 0 or 2, with which the program
/// must then end, or std::nullopt if there is no such argument. Call this before ros::init(), so
/// that the program does not wait for a master.
std::optional<int> answer_arguments(int argc, char** argv, const ProgramHelp& help);

/// The type of a topic, as --help shows it.
template <typename Message>
std::string message_type() {
  return ros::message_traits::datatype<Message>();
}

/// The type of a service, as --help shows it.
template <typename Service>
std::string service_type() {
  return ros::service_traits::datatype<Service>();
}

/// The main function of a node. If there are arguments to answer, it answers them. Otherwise, it
/// starts ROS, calls `run`, and logs an exception that `run` throws. SIGTERM ends ROS as SIGINT
/// does. Returns the exit code. `name`: the node's default name. `options`: flags of
/// ros::init_options.
int run_program(int argc, char** argv, const ProgramHelp& help, const std::string& name,
                void (*run)(const ros::NodeHandle& node, const ros::NodeHandle& private_node),
                std::uint32_t options = 0);

/// The tasks of a node on /diagnostics. This is not diagnostic_updater::Updater, which reads a
/// parameter in each update. For that, it waits for a mutex of roscpp, which a thread that sets a
/// parameter holds until the ROS master answers.
class DiagnosticTasks final : public diagnostic_updater::DiagnosticTaskVector {
 public:
  /// `name`: of the node.
  DiagnosticTasks(ros::NodeHandle node, const std::string& name)
      : name_(name), topic_(node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1)) {}
  virtual ~DiagnosticTasks() = default;  ///< The base class has virtual functions, but not this.

  /// Calls all tasks, and publishes what they say.
  void publish();

 private:
  std::string name_;
  ros::Publisher topic_;
};

/// What a node publishes on /diagnostics: the tasks that its parts add, whether simulated time has
/// begun, and whether the ROS master still lists this process. A restarted master does not list it,
/// because roscpp does not register again. The master is asked once a second, in a thread of its
/// own.
class Diagnostics {
 public:
  /// `period_sec`: the wall time between two messages. They are published in the thread that calls
  /// the callbacks of `private_node`.
  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, double period_sec);

  DiagnosticTasks& tasks() { return tasks_; }
  /// The queue of the thread that may wait for the ROS master.
  ros::CallbackQueue& master_queue() { return asking_.queue(); }

 private:
  void ask_master();
  void diagnose_master(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  DiagnosticTasks tasks_;
  std::atomic<const char*> master_;  ///< what is known of the master
  int without_clock_ = 0;            ///< [s] how long simulated time has not begun
  QueueThread asking_;
  ros::WallTimer publish_, ask_;
};

}  // namespace organ_collision
