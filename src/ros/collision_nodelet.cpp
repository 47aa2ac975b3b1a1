#include <nodelet/nodelet.h>

#include <atomic>
#include <future>
#include <pluginlib/class_list_macros.hpp>
#include <thread>

#include "organ_collision/ros/collision_node.hpp"

namespace organ_collision {

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
      node = std::make_unique<CollisionNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());
      return ready.set_exception(std::current_exception());
    }
    ready.set_value();
    node->run([this] { return stop_.load(); });
  }

  std::atomic<bool> stop_{false};
  std::thread worker_;
};

}  // namespace organ_collision

PLUGINLIB_EXPORT_CLASS(organ_collision::CollisionNodelet, nodelet::Nodelet)
