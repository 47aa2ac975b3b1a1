#include <pluginlib/class_list_macros.hpp>

#include "common/program/threaded_nodelet.hpp"
#include "haptic_proxy.hpp"

namespace organ_collision {

using HapticProxyNodelet = ThreadedNodelet<run_haptic_proxy>;

}  // namespace organ_collision

PLUGINLIB_EXPORT_CLASS(organ_collision::HapticProxyNodelet, nodelet::Nodelet)
