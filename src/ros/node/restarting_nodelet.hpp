#pragma once

#include <nodelet/nodelet.h>
#include <ros/init.h>

#include <atomic>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <thread>
#include <utility>

#include "program.hpp"

namespace organ_collision {

/// A node in a nodelet manager: messages of the same process arrive without copies. The node works
/// in a thread of its own. If it breaks down, it is started again. `Node` has the functions of
/// CollisionNode.
template <typename Node>
class RestartingNodelet : public nodelet::Nodelet {
 public:
  ~RestartingNodelet() override {
    stop_ = true;
    if (worker_.joinable()) worker_.join();
  }

 private:
  /// [s] The pause before a restart. Without it, a node that breaks down at once would keep a
  /// processor busy.
  static constexpr double kPauseSec = 0.5;

  /// Returns when the node works. If it cannot be constructed, throws its exception, so that
  /// loading the nodelet fails.
  void onInit() override {
    guard_parameter_updates();
    std::promise<void> ready;
    std::future<void> outcome = ready.get_future();
    // The promise moves to the worker, which may still use it when this function has returned.
    worker_ = std::thread([this, ready = std::move(ready)]() mutable {
      std::unique_ptr<Node> node;
      try {
        node = make_node();
      } catch (const std::exception& error) {
        NODELET_FATAL("%s", error.what());
        return ready.set_exception(std::current_exception());
      }
      ready.set_value();
      run(std::move(node));
    });
    outcome.get();
  }

  std::unique_ptr<Node> make_node() {
    return std::make_unique<Node>(getNodeHandle(), getPrivateNodeHandle());
  }

  /// A node that breaks down is started again. The manager and its other nodelets keep running.
  void run(std::unique_ptr<Node> node) {
    while (!is_to_stop()) {
      try {
        if (!node) node = make_node();
        node->run([this] { return is_to_stop(); });
        return;
      } catch (const std::exception& error) {
        NODELET_FATAL("broke down, and starts anew, without organs and history: %s", error.what());
      }
      node.reset();
      const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPauseSec);
      while (!is_to_stop() && ros::WallTime::now() < end) ros::WallDuration(0.05).sleep();
    }
  }

  bool is_to_stop() const { return stop_ || !ros::ok(); }

  std::atomic<bool> stop_{false};
  std::thread worker_;
};

}  // namespace organ_collision
