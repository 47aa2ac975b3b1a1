#pragma once

#include <ros/node_handle.h>

#include "common/program/program.hpp"

namespace organ_collision {

/// Runs the collision node until ROS shuts down or `control` stops it. Throws ParameterError and
/// GlError. Throws an exception that the node cannot recover from, such as std::bad_alloc, after it
/// has published PICKER_FAILED for each organ and tool.
void run_collision_node(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                        const RunControl& control);

}  // namespace organ_collision
