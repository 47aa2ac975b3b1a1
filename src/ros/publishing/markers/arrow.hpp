#pragma once

#include <visualization_msgs/Marker.h>

#include <Eigen/Core>

namespace organ_collision {

/// Adds the triangles of a solid arrow from `tail` to `head` to a TRIANGLE_LIST. Unlike markers of
/// type ARROW, any number of arrows is one marker.
void add_arrow(const Eigen::Vector3d& tail, const Eigen::Vector3d& head,
               visualization_msgs::Marker& list);

/// Adds the head alone: a solid cone around the line from `base` to `apex`, whose base has this
/// radius.
void add_arrow_head(const Eigen::Vector3d& base, const Eigen::Vector3d& apex, double radius,
                    visualization_msgs::Marker& list);

}  // namespace organ_collision
