#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "collision_node.hpp"
#include "restarting_nodelet.hpp"

namespace organ_collision {

class CollisionNodelet : public RestartingNodelet {
 public:
  ~CollisionNodelet() override { stop(); }

 private:
  Run make_node() override {
    const auto node = std::make_shared<CollisionNode>(getNodeHandle(), getPrivateNodeHandle());
    return [node](const std::function<bool()>& stop) { node->run(stop); };
  }
};

}  // namespace organ_collision

PLUGINLIB_EXPORT_CLASS(organ_collision::CollisionNodelet, nodelet::Nodelet)
