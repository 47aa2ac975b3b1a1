#pragma once

#include <nodelet/nodelet.h>
#include <ros/init.h>

#include <exception>
#include <future>
#include <thread>
#include <utility>

#include "program.hpp"

namespace organ_collision {

/// A node in a nodelet manager: messages of the same process arrive without copies. The node works
/// in a thread of its own. If it breaks down, it is started again. `kRun` runs the node.
template <void (*kRun)(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                       const RunControl& control)>
class RestartingNodelet : public nodelet::Nodelet {
 public:
  ~RestartingNodelet() override {
    control_.stop = true;
    if (worker_.joinable()) worker_.join();
  }

 private:
  /// [s] The pause before a restart. Without it, a node that breaks down at once would keep a
  /// processor busy.
  static constexpr double kPauseSec = 0.5;

  /// Returns when the node works. If it cannot be constructed, throws its exception, so that
  /// loading the nodelet fails.
  void onInit() override {
    std::promise<void> ready;
    std::future<void> outcome = ready.get_future();
    // The promise moves to the worker, which may still use it when this function has returned.
    worker_ = std::thread([this, ready = std::move(ready)]() mutable { work(ready); });
    outcome.get();
  }

  /// Runs the node. If it breaks down, it is started again; the manager and its other nodelets keep
  /// running. `ready` gets the outcome of the first start.
  void work(std::promise<void>& ready) {
    bool is_first = true;
    control_.ready = [&] {
      if (std::exchange(is_first, false)) ready.set_value();
    };
    while (is_first || !is_to_stop()) {
      try {
        return kRun(getNodeHandle(), getPrivateNodeHandle(), control_);
      } catch (const std::exception& error) {
        if (is_first) {
          NODELET_FATAL("%s", error.what());
          return ready.set_exception(std::current_exception());
        }
        NODELET_FATAL("broke down, and starts anew, without organs and history: %s", error.what());
      }
      const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPauseSec);
      while (!is_to_stop() && ros::WallTime::now() < end) ros::WallDuration(0.05).sleep();
    }
  }

  bool is_to_stop() const { return control_.stop || !ros::ok(); }

  RunControl control_;
  std::thread worker_;
};

}  // namespace organ_collision
