#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>

#include <vector>

#include "tool_course.hpp"

namespace organ_collision::stress {

/// The trocars, for /tf_static.
std::vector<geometry_msgs::TransformStamped> resting_transforms(ros::Time stamp);
/// The tips of "probe" and "needle" and the link "jaw", for /tf.
std::vector<geometry_msgs::TransformStamped> moving_transforms(const ToolPlaces& places,
                                                               ros::Time stamp);
/// The tip of "stylus", for its own topic.
geometry_msgs::PoseStamped stylus_pose(const ToolPlaces& places, ros::Time stamp);

}  // namespace organ_collision::stress
