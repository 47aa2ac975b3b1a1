#pragma once

#include <ros/node_handle.h>

#include "common/program/program.hpp"

namespace organ_collision {

/// Runs the node haptic_proxy until ROS shuts down or `control` stops it. Throws ParameterError,
/// GlError, and exceptions that the node cannot recover from, such as std::bad_alloc. Before it
/// returns or throws, forces fade and NO_ANSWER is published for each tool that has a proxy, if ROS
/// still works.
void run_haptic_proxy(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                      const RunControl& control);

}  // namespace organ_collision
