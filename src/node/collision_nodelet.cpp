#include <pluginlib/class_list_macros.hpp>

#include "collision_node.hpp"
#include "common/program/threaded_nodelet.hpp"

namespace organ_collision {

using CollisionNodelet = ThreadedNodelet<run_collision_node>;

}  // namespace organ_collision

PLUGINLIB_EXPORT_CLASS(organ_collision::CollisionNodelet, nodelet::Nodelet)
