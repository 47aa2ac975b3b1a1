#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <functional>
#include <optional>

#include "ros/interface/failure_log.hpp"
#include "ros/steps/wait_clock.hpp"

namespace organ_collision {

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

}  // namespace organ_collision
