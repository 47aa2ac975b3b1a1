#pragma once

#include <organ_collision/ListTools.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>

#include <deque>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/program/program.hpp"
#include "common/threads/queues.hpp"
#include "common/threads/realtime.hpp"
#include "node/inbox.hpp"
#include "node/parameters/node_parameters.hpp"
#include "node/steps/step.hpp"
#include "node/tools/tool.hpp"

namespace organ_collision {

/// What a node with organs does. The thread that calls NodeCore::run() calls these functions,
/// unless they say otherwise. It calls none of them before run(): by then, the node is complete.
class OrganNode {
 public:
  /// `inbox`: of the node. It is not used before run().
  explicit OrganNode(Inbox& inbox) : inbox_(inbox) {}
  virtual ~OrganNode() = default;

  Inbox& its_inbox() { return inbox_; }

  /// Called once, before all others: subscribes to topics, and advertises services.
  virtual void start() = 0;
  /// Called before and after each callback, when the inbox has looked at the clock. `now`: see
  /// MessageLoop::now().
  virtual void handle(SteadyTime now) = 0;
  /// Called after each batch of messages. Returns when it must be called again even if no message
  /// comes, on the clock of the loop; std::nullopt: never.
  virtual std::optional<SteadyTime> work() = 0;
  /// Called after parameters have changed.
  virtual void parameters_changed() = 0;
  /// Called in the background thread: makes what takes long or waits for the ROS master, for a new
  /// list of tools, and then releases the tools that are not kept. Adds a fault to a tool that does
  /// not work. If it throws, the old tools stay. Returns what takes over when NodeCore::tools() are
  /// the new tools; if that throws, the node breaks down. What the function holds then is destroyed
  /// in the background thread.
  virtual std::function<void()> prepare_tools(std::vector<Tool>& tools, const KeptTools& kept) = 0;
  /// Called once, after all others: tells the subscribers that the node ends. `fault`: the
  /// exception because of which it ends, or null.
  virtual void end(const std::exception* fault) = 0;

 private:
  Inbox& inbox_;
};

/// The callback queue of a node. One thread calls its callbacks in batches. That thread owns all
/// state of the node, so that the state needs no locks.
class MessageLoop {
 public:
  ~MessageLoop() { end(); }

  ros::CallbackQueue& queue() { return queue_; }

  /// Waits for the first callback until a deadline, but at most 10 ms. Then calls all callbacks
  /// that are there, for at most 2 ms, and OrganNode::handle() around each of them. Throws what the
  /// callbacks throw.
  void receive(OrganNode& node, std::optional<SteadyTime> deadline);
  /// All messages that came before this time, on the clock of now(), have been handled, unless the
  /// node is more than 1 s behind its messages.
  SteadyTime heard_until() const { return heard_until_; }
  /// The present time on the clock of the deadlines.
  SteadyTime now() { return clock_.now(); }

  /// Drops all callbacks in the queue, and those that come later. A thread that waits for a
  /// callback goes on.
  void end();

 private:
  bool call_one(OrganNode& node, ros::WallDuration wait);

  ros::CallbackQueue queue_;
  WaitClock clock_;
  SteadyTime heard_until_;
};

/// What --help says of a node with organs, without its own topics, services and parameters.
/// `reset`: what its service `reset` does.
ProgramHelp organ_node_help(const std::string& program, const std::string& purpose,
                            const std::string& reset);

/// What all nodes with organs have: the loop of their thread, background threads, parameters and
/// tools that can be changed while the node runs, the services `reset` and `list_tools`, real-time
/// scheduling, and /diagnostics.
class NodeCore {
 public:
  /// `table`: that of the parameters. Both must outlive this. The same thread must call run().
  NodeCore(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
           OrganNodeParameters& parameters, const ParameterTable& table);

  MessageLoop& loop() { return loop_; }
  OrganIntake::Threads organ_threads() { return {loop_.queue(), builder_, inspector_}; }
  /// Starts a thread for work that no step waits for, and returns its queue. The thread ends before
  /// run() returns.
  ros::CallbackQueue& start_thread() { return threads_.emplace_back().queue(); }
  /// The callbacks of both node handles are called in the node's thread.
  const ros::NodeHandle& node() const { return node_; }
  ros::NodeHandle& private_node() { return private_node_; }
  const std::vector<Tool>& tools() const { return tools_; }
  std::vector<Tool>& tools() { return tools_; }
  DiagnosticTasks& diagnostics() { return diagnostics_.tasks(); }
  ros::CallbackQueue& master_queue() { return diagnostics_.master_queue(); }

  /// Runs the node until ROS shuts down or `control` stops it. When this returns or throws, all
  /// threads have ended. Throws what OrganNode::start() throws, and an exception that the node
  /// cannot recover from, such as std::bad_alloc.
  void run(OrganNode& node, const RunControl& control);

  /// Runs an action in the node's thread, and waits for its end. Call it in another thread.
  template <typename Action>
  void in_node_thread(const Action& action) {
    run_in_thread_of(loop_.queue(), action);
  }

 private:
  void start(OrganNode& node);
  void end_threads();
  void number_histories(std::vector<Tool>& tools, const KeptTools& kept);
  void reload(std_srvs::Trigger::Response& response);
  void exchange_tools(std::vector<Tool>& tools, std::vector<ToolParameters>& parameters,
                      std::vector<std::string>& misspelt, const std::function<void()>& take_over);
  void say_last_words(const std::exception& fault);

  MessageLoop loop_;
  std::deque<QueueThread> threads_;
  // The background thread may wait for the ROS master. So it inspects no surfaces.
  ros::CallbackQueue &background_ = start_thread(), &builder_ = start_thread(),
                     &inspector_ = start_thread();
  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  OrganNodeParameters& parameters_;
  const ParameterTable& table_;
  Realtime realtime_;
  std::vector<Tool> tools_;
  std::uint64_t tool_histories_ = 0;  ///< how many histories of tools have begun
  std::exception_ptr broken_;         ///< why the node cannot go on; null: it can
  Diagnostics diagnostics_;
  LiveParameters live_parameters_;  ///< its callbacks run in the background thread
  OrganNode* running_ = nullptr;    ///< the node, while it runs
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace organ_collision
