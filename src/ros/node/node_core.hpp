#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ros/messages/failure_log.hpp"
#include "ros/parameters/tool_parameters.hpp"
#include "ros/steps/wait_clock.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// A thread that calls the callbacks of its own queue, with lowered priority: for work that no step
/// waits for. It ends with this object at the latest.
class QueueThread {
 public:
  QueueThread();
  ~QueueThread();
  QueueThread(const QueueThread&) = delete;
  QueueThread& operator=(const QueueThread&) = delete;

  /// Ends the thread after the callback that it is calling. What else is in the queue stays there.
  void stop();
  /// What is added to this queue is called in the thread.
  ros::CallbackQueue& queue() { return queue_; }

 private:
  void work();

  ros::CallbackQueue queue_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The callback queue of a node, whose callbacks one thread calls in batches. That thread owns all
/// state of the node, so that the state needs no locks.
class MessageLoop {
 public:
  /// What the node does around the callbacks.
  struct Actions {
    std::function<void()> watch_clock;           ///< before and after each callback
    std::function<void(SteadyTime now)> handle;  ///< after each callback; `now`: of now()
  };

  /// `rejected` gets the exceptions that guard() caught. It must outlive this.
  MessageLoop(FailureLog& rejected, Actions actions)
      : rejected_(rejected), actions_(std::move(actions)) {}
  ~MessageLoop() { end(); }
  MessageLoop(const MessageLoop&) = delete;
  MessageLoop& operator=(const MessageLoop&) = delete;

  ros::CallbackQueue& queue() { return queue_; }

  /// Waits for the first callback, but not beyond `deadline`, a time of now(). Then calls all
  /// callbacks that are there, for at most 2 ms.
  void receive(std::optional<SteadyTime> deadline);
  /// All messages that came before this time of now() have been handled.
  SteadyTime heard_until() const { return heard_until_; }
  /// The time of deadlines.
  SteadyTime now() { return clock_.now(); }

  /// Runs an action. If it throws, the exception is counted, and the node goes on.
  void guard(const std::function<void()>& action);
  /// Drops the callbacks, and all that come later. A thread that waits for one of them goes on.
  void end();

 private:
  ros::WallDuration wait(std::optional<SteadyTime> deadline, SteadyTime now) const;
  bool call_one(ros::WallDuration wait);

  ros::CallbackQueue queue_;
  FailureLog& rejected_;
  Actions actions_;
  WaitClock clock_;
  SteadyTime heard_until_;
};

/// The same node handle, with its callbacks in `queue`.
ros::NodeHandle on_queue(ros::NodeHandle node, ros::CallbackQueue& queue);

/// The tools, and one sentence for each unknown name among all parameters.
struct LoadedToolList {
  std::vector<Tool> tools;
  std::vector<std::string> misspelt;
};

std::vector<Tool> load_tools(const std::vector<ToolParameters>& parameters,
                             const ros::NodeHandle& private_node);

/// Logs what is doubtful about the parameters of a node: unknown names, tools that do not work, and
/// implausible sizes.
void warn_of_settings(const std::vector<Tool>& tools, const std::vector<std::string>& misspelt);

/// Serves `reload_tools`. Robots' files may take seconds to load. Therefore the node handle must
/// have a callback queue with a thread of its own: the node's thread only exchanges the lists.
class ToolReload {
 public:
  /// Exchanges the node's lists for `loaded`, which then has the old ones.
  using Exchange = std::function<void(LoadedToolList& loaded, const KeptTools& kept)>;

  /// Reads the tools that the parameter server has now. Throws ParameterError.
  using Load = std::function<LoadedTools()>;

  /// `tools`: the node's list, which only `exchange` may change.
  ToolReload(ros::NodeHandle private_node, const std::vector<Tool>& tools, Load load,
             Exchange exchange);

  /// From now on, the exchange may be called at any time.
  void advertise();

 private:
  bool on_reload(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  std::string reload();

  ros::NodeHandle private_node_;
  const std::vector<Tool>& tools_;
  Load load_;
  Exchange exchange_;
  ros::ServiceServer server_;
};

}  // namespace organ_collision
