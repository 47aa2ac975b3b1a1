#pragma once

#include <organ_collision/ListTools.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>

#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/messages/text.hpp"
#include "common/program/program.hpp"
#include "common/threads/queues.hpp"
#include "common/threads/realtime.hpp"
#include "node/organs/organ_intake.hpp"
#include "node/parameters/node_parameters.hpp"
#include "node/steps/step.hpp"
#include "node/tools/tool.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {

/// The callback queue of a node. One thread calls its callbacks in batches. That thread owns all
/// state of the node, so that the state needs no locks.
class MessageLoop {
 public:
  /// What the node does around the callbacks.
  struct Callbacks {
    std::function<void()> watch_clock;           ///< before and after each callback
    std::function<void(SteadyTime now)> handle;  ///< after each callback; `now`: see now()
  };

  explicit MessageLoop(Callbacks callbacks) : callbacks_(std::move(callbacks)) {}
  ~MessageLoop() { end(); }

  ros::CallbackQueue& queue() { return queue_; }

  /// Waits for the first callback until `deadline` on the clock of now(), but at most 10 ms. Then
  /// calls all callbacks that are there, for at most 2 ms. Throws what the callbacks throw.
  void receive(std::optional<SteadyTime> deadline);
  /// All messages that came before this time, on the clock of now(), have been handled, unless the
  /// node is more than 1 s behind its messages.
  SteadyTime heard_until() const { return heard_until_; }
  /// The present time on the clock of the deadlines.
  SteadyTime now() { return clock_.now(); }

  /// Drops all callbacks in the queue, and those that come later. A thread that waits for a
  /// callback goes on.
  void end();

 private:
  ros::WallDuration wait(std::optional<SteadyTime> deadline, SteadyTime now) const;
  bool call_one(ros::WallDuration wait);

  ros::CallbackQueue queue_;
  Callbacks callbacks_;
  WaitClock clock_;
  SteadyTime heard_until_;
};

/// What --help says of a node with organs, without its own topics, services and parameters.
/// `reset`: what its service `reset` does.
ProgramHelp organ_node_help(const std::string& program, const std::string& purpose,
                            const std::string& reset);

/// Logs what is doubtful about the parameters of a node: unknown names, tools that do not work, and
/// implausible sizes.
void warn_of_settings(const std::vector<Tool>& tools, const std::vector<std::string>& misspelt);

/// Compares the old tools of a node with new ones. Throws ToolError if a new or changed tool has a
/// fault. An unchanged tool may keep its fault.
ToolChanges accepted_changes(const std::vector<Tool>& old_tools,
                             const std::vector<Tool>& new_tools);

/// What all nodes with organs have: the loop of their thread, a background thread, parameters and
/// tools that can be changed while the node runs, the services `reset` and `list_tools`, real-time
/// scheduling, and /diagnostics. `Parameters`: derived from OrganNodeParameters.
template <typename Parameters>
class NodeCore {
 public:
  /// What the node does. All functions are called in the node's thread, unless they say otherwise.
  struct Callbacks {
    MessageLoop::Callbacks loop;
    /// Called after each batch of messages.
    std::function<void()> work;
    /// When `work` must be called even if no message comes, on the clock of the loop.
    std::function<std::optional<SteadyTime>()> next_deadline;
    std::function<void()> reset;
    std::function<void(const Parameters& before)> parameters_changed;
    /// Called in the background thread, before the tools that are not kept are replaced.
    std::function<void(const KeptTools& kept)> release_tools = [](const KeptTools&) {};
    /// Gets the parameters of the new tools before they replace the old ones. If it throws, the old
    /// tools stay.
    std::function<void(const std::vector<ToolParameters>& tools)> prepare_tools;
    /// Called when tools() returns the new tools. If it throws, the node breaks down.
    std::function<void(const KeptTools& kept)> tools_changed;
    /// Called before the node ends because of an exception: tells the subscribers.
    std::function<void(const std::string& why)> break_down;
  };

  /// Throws ParameterError. The same thread must call run().
  NodeCore(const ros::NodeHandle& node, const ros::NodeHandle& private_node, Callbacks callbacks)
      : callbacks_(std::move(callbacks)),
        loop_(callbacks_.loop),
        node_(on_queue(node, loop_.queue())),
        private_node_(on_queue(private_node, loop_.queue())),
        parameters_(load_parameters<Parameters>(private_node_)),
        realtime_(parameters_.realtime),
        tools_(load_tools(parameters_.tools, private_node_)),
        diagnostics_(node_, private_node_, parameters_.diagnostic_period_sec),
        live_parameters_(on_queue(private_node, background_.queue()), live_parameters(parameters_),
                         [this](const auto& changes) { return change_parameters(changes); }) {}
  ~NodeCore() { end(); }

  MessageLoop& loop() { return loop_; }
  OrganIntake::Threads organ_threads() {
    return {loop_.queue(), builder_.queue(), background_.queue()};
  }
  /// The callbacks of both node handles are called in the node's thread.
  const ros::NodeHandle& node() const { return node_; }
  ros::NodeHandle& private_node() { return private_node_; }
  const Parameters& parameters() const { return parameters_; }
  const std::vector<Tool>& tools() const { return tools_; }
  std::vector<Tool>& tools() { return tools_; }
  diagnostic_updater::Updater& updater() { return diagnostics_.updater(); }

  /// From now on, the callbacks may be called.
  void start() {
    warn_of_settings(tools_, parameters_.misspelt);
    live_parameters_.advertise();
    reload_ = on_queue(private_node_, background_.queue())
                  .advertiseService(names::kReloadTools, &NodeCore::on_reload, this);
    reset_ = private_node_.advertiseService(names::kReset, &NodeCore::on_reset, this);
    list_ = private_node_.advertiseService(names::kListTools, &NodeCore::on_list, this);
    updater().add("scheduling", &realtime_, &Realtime::diagnose);
  }

  /// Works until ROS shuts down or `stop` returns true. Throws an exception that the node cannot
  /// recover from, such as std::bad_alloc, after Callbacks::break_down was called.
  void run(const std::function<bool()>& stop) {
    try {
      while (private_node_.ok() && !stop()) {
        loop_.receive(callbacks_.next_deadline());
        if (broken_) std::rethrow_exception(broken_);
        callbacks_.work();
      }
    } catch (const std::exception& error) {
      say_last_words(error.what());
      throw;
    }
  }

  /// Releases the threads that wait for the node's thread. Then ends the background threads, which
  /// use members. A node must call it before it destroys what the callbacks use.
  void end() {
    loop_.end();
    background_.stop();
    builder_.stop();
  }

  /// Runs an action in the node's thread, and waits for its end. Call it in another thread.
  void in_node_thread(const std::function<void()>& action) {
    run_in_thread_of(loop_.queue(), action);
  }

 private:
  /// Runs in the background thread, because robots' files may take seconds to load.
  bool on_reload(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    try {
      Parameters loaded;
      const ParameterTable table = table_of(loaded);
      const ParameterGroup all = table.group(all_parameters(private_node_));
      loaded.misspelt = all.misspelt();
      table.read(all, names::kTools);
      std::vector<Tool> tools = load_tools(loaded.tools, private_node_);
      const ToolChanges changes = accepted_changes(tools_, tools);
      callbacks_.release_tools(changes.kept);
      in_node_thread([&] { exchange_tools(tools, loaded, changes.kept); });
      response.success = true;
      response.message = plain_text(changes.summary, kLongestMessage);
      ROS_INFO("tools are reloaded: %s", response.message.c_str());
    } catch (const std::exception& error) {
      response.message = plain_text(error.what(), kLongestMessage);
      ROS_WARN("tools stay as they were: %s", response.message.c_str());
    }
    return true;
  }

  void exchange_tools(std::vector<Tool>& tools, OrganNodeParameters& loaded,
                      const KeptTools& kept) {
    callbacks_.prepare_tools(loaded.tools);
    try {
      std::swap(tools_, tools);
      std::swap(parameters_.misspelt, loaded.misspelt);
      std::swap(parameters_.tools, loaded.tools);
      callbacks_.tools_changed(kept);
      warn_of_settings(tools_, parameters_.misspelt);
    } catch (...) {
      broken_ = std::current_exception();
      throw;
    }
  }

  bool on_reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
    callbacks_.reset();
    return true;
  }

  bool on_list(ListTools::Request&, ListTools::Response& response) {
    for (const Tool& tool : tools_) response.tools.push_back(info_of(tool));
    return true;
  }

  /// Runs in the background thread. Only this thread ever makes the node's thread change
  /// parameters.
  std::vector<LiveParameter> change_parameters(const XmlRpc::XmlRpcValue& changes) {
    const Parameters now = changed(parameters_, changes);
    in_node_thread([&] {
      const Parameters before = std::exchange(parameters_, now);
      callbacks_.parameters_changed(before);
    });
    return live_parameters(now);
  }

  void say_last_words(const std::string& why) {
    try {
      callbacks_.break_down(why);
      updater().force_update();
    } catch (const std::exception&) {  // The exception that ends the node is more important.
    }
    ros::WallDuration(1.0).sleep();  // Time for the last messages to be sent.
  }

  Callbacks callbacks_;
  MessageLoop loop_;
  QueueThread background_, builder_;
  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  Parameters parameters_;
  Realtime realtime_;
  std::vector<Tool> tools_;
  std::exception_ptr broken_;  ///< why the node cannot go on; null: it can
  Diagnostics diagnostics_;
  LiveParameters live_parameters_;  ///< its callbacks run in the background thread
  ros::ServiceServer reload_, reset_, list_;
};

}  // namespace organ_collision
