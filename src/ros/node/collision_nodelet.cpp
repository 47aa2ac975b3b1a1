#include <nodelet/nodelet.h>
#include <ros/init.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <thread>
#include <utility>

#include "collision_node.hpp"

namespace organ_collision {
namespace {

/// [s] The pause before a restart. Without it, a node that breaks down at once would keep a
/// processor busy. It doubles each time the node cannot be constructed.
constexpr double kShortestPauseSec = 0.2;
constexpr double kLongestPauseSec = 5.0;
/// How soon a request to stop is noticed within a pause.
const ros::WallDuration kPauseStep(0.05);

}  // namespace

/// The node in a nodelet manager: messages of the same process arrive without copies.
class CollisionNodelet : public nodelet::Nodelet {
 public:
  ~CollisionNodelet() override {
    stop_ = true;
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

  void work(std::promise<void>& ready) {
    std::unique_ptr<CollisionNode> node;
    try {
      node = make_node();
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());
      return ready.set_exception(std::current_exception());
    }
    ready.set_value();
    run(std::move(node));
  }

  std::unique_ptr<CollisionNode> make_node() {
    return std::make_unique<CollisionNode>(getNodeHandle(), getPrivateNodeHandle());
  }

  /// A node that breaks down is started again. The manager and its other nodelets keep running.
  void run(std::unique_ptr<CollisionNode> node) {
    double pause_sec = kShortestPauseSec;
    while (!is_to_stop()) {
      try {
        if (!node) node = make_node();
        node->run([this] { return is_to_stop(); });
        return;
      } catch (const std::exception& error) {
        NODELET_FATAL("broke down, and starts anew, without organs and history: %s", error.what());
        pause_sec = node ? kShortestPauseSec : std::min(2.0 * pause_sec, kLongestPauseSec);
      }
      node.reset();
      pause(pause_sec);
    }
  }

  void pause(double seconds) const {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (!is_to_stop() && ros::WallTime::now() < end) kPauseStep.sleep();
  }

  bool is_to_stop() const { return stop_ || !ros::ok(); }

  std::atomic<bool> stop_{false};
  std::thread worker_;
};

}  // namespace organ_collision

PLUGINLIB_EXPORT_CLASS(organ_collision::CollisionNodelet, nodelet::Nodelet)
