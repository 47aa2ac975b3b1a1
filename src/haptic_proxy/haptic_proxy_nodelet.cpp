#include <pluginlib/class_list_macros.hpp>

#include "haptic_proxy_node.hpp"
#include "ros/node/restarting_nodelet.hpp"

namespace organ_collision {

using HapticProxyNodelet = RestartingNodelet<HapticProxyNode>;

}  // namespace organ_collision

PLUGINLIB_EXPORT_CLASS(organ_collision::HapticProxyNodelet, nodelet::Nodelet)
