#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Polygon.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>
#include <organ_collision/Contact.h>
#include <organ_collision/ToolMotion.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/contact.hpp"
#include "picking/pickers/region_clipper.hpp"

namespace organ_collision {

// Between messages and the core's types; lengths in metres on both sides.

Eigen::Vector3d to_eigen(const geometry_msgs::Point& point);
Eigen::Isometry3d to_eigen(const geometry_msgs::Transform& transform);

geometry_msgs::Point to_point(const Eigen::Vector3d& point);
geometry_msgs::Vector3 to_vector(const Eigen::Vector3d& vector);
Contact to_message(const FaceContact& contact);
geometry_msgs::Polygon to_message(const Region& region);

/// The straight motion of a message, moved into the target frame: two waypoints, or the end alone
/// when `at_end_only`.
ToolPath to_path(const ToolMotion& motion, bool at_end_only,
                 const Eigen::Isometry3d& T_target_source);

/// A frame's name as tf2 takes it: without the leading slash of old.
std::string tf_frame(const std::string& frame_id);

}  // namespace organ_collision
