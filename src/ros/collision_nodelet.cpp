#include <nodelet/nodelet.h>
#include <ros/init.h>

#include <atomic>
#include <future>
#include <pluginlib/class_list_macros.hpp>
#include <thread>

#include "organ_collision/ros/collision_node.hpp"

namespace organ_collision {
namespace {

const ros::WallDuration kBetweenStarts(0.2);

}  // namespace

/// The node in a nodelet manager: messages of the same process arrive without copies.
class CollisionNodelet : public nodelet::Nodelet {
 public:
  ~CollisionNodelet() override {
    stop_ = true;
    if (worker_.joinable()) worker_.join();
  }

 private:
  /// Returns when the node works; throws what stopped it, so that loading fails.
  void onInit() override {
    std::promise<void> ready;
    std::future<void> outcome = ready.get_future();
    worker_ = std::thread([this, &ready] { work(ready); });
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
    while (!run(node)) node.reset();
  }

  std::unique_ptr<CollisionNode> make_node() {
    return std::make_unique<CollisionNode>(getNodeHandle(), getPrivateNodeHandle());
  }

  /// False: the node broke down, and starts anew. Its manager and the nodelets beside it live on.
  bool run(std::unique_ptr<CollisionNode>& node) {
    const auto stop = [this] { return stop_ || !ros::ok(); };
    try {
      if (!node) node = make_node();
      node->run(stop);
      return true;
    } catch (const std::exception& error) {
      NODELET_FATAL("broke down, and starts anew, without organs and history: %s", error.what());
    }
    // Or it might do nothing but break down.
    if (!stop()) kBetweenStarts.sleep();
    return stop();
  }

  std::atomic<bool> stop_{false};
  std::thread worker_;
};

}  // namespace organ_collision

PLUGINLIB_EXPORT_CLASS(organ_collision::CollisionNodelet, nodelet::Nodelet)
