#pragma once

#include <nodelet/nodelet.h>

#include <exception>
#include <future>
#include <thread>
#include <utility>

#include "program.hpp"

namespace organ_collision {

/// A node in a nodelet manager: messages of the same process arrive without copies. The node works
/// in a thread of its own. If it breaks down, the log says why, and the manager and its other
/// nodelets keep running. `kRun` runs the node.
template <void (*kRun)(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                       const RunControl& control)>
class ThreadedNodelet : public nodelet::Nodelet {
 public:
  ~ThreadedNodelet() override {
    control_.stop = true;
    if (worker_.joinable()) worker_.join();
  }

 private:
  /// Returns when the node works. If it cannot be constructed, throws its exception, so that
  /// loading the nodelet fails.
  void onInit() override {
    std::promise<void> ready;
    std::future<void> outcome = ready.get_future();
    // The promise moves to the worker, which may still use it when this function has returned.
    worker_ = std::thread([this, ready = std::move(ready)]() mutable { work(ready); });
    outcome.get();
  }

  /// Runs the node until it ends. `ready` gets the outcome of its start.
  void work(std::promise<void>& ready) {
    bool is_ready = false;
    control_.ready = [&] {
      is_ready = true;
      ready.set_value();
    };
    try {
      kRun(getNodeHandle(), getPrivateNodeHandle(), control_);
    } catch (const std::exception& error) {
      if (is_ready) {
        NODELET_FATAL(
            "nodelet %s broke down, and answers nothing more: %s; unload it, and load it again",
            getName().c_str(), error.what());
      } else {
        NODELET_FATAL("%s", error.what());
        ready.set_exception(std::current_exception());
      }
    }
  }

  RunControl control_;
  std::thread worker_;
};

}  // namespace organ_collision
