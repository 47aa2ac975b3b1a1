#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "haptic_proxy_node.hpp"
#include "ros/node/restarting_nodelet.hpp"

namespace organ_collision {

class HapticProxyNodelet : public RestartingNodelet {
 public:
  ~HapticProxyNodelet() override { stop(); }

 private:
  Run make_node() override {
    const auto node = std::make_shared<HapticProxyNode>(getNodeHandle(), getPrivateNodeHandle());
    return [node](const std::function<bool()>& stop) { node->run(stop); };
  }
};

}  // namespace organ_collision

PLUGINLIB_EXPORT_CLASS(organ_collision::HapticProxyNodelet, nodelet::Nodelet)
