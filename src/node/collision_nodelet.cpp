#include <pluginlib/class_list_macros.hpp>

#include "collision_node.hpp"
#include "common/program/restarting_nodelet.hpp"

namespace organ_collision {

using CollisionNodelet = RestartingNodelet<run_collision_node>;

}  // namespace organ_collision

PLUGINLIB_EXPORT_CLASS(organ_collision::CollisionNodelet, nodelet::Nodelet)
