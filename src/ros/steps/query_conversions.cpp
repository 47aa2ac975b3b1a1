#include "query_conversions.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include "ros/interface/conversions.hpp"

namespace organ_collision {

Contact to_message(const FaceContact& contact) {
  Contact message;
  message.face = contact.face;
  for (std::size_t i = 0; i < 3; ++i) message.vertices[i] = contact.vertices[i];
  message.link = contact.link;
  message.fraction = contact.fraction;
  message.point = tf2::toMsg(contact.point);
  message.normal = to_vector(contact.normal);
  for (std::size_t i = 0; i < 3; ++i) message.barycentric[i] = contact.barycentric[i];
  message.shaft = contact.shaft;
  message.depth = contact.depth;
  message.behind = contact.behind;
  message.end_point = tf2::toMsg(contact.end_point);
  message.view_min = contact.view_min;
  message.view_max = contact.view_max;
  return message;
}

geometry_msgs::Polygon to_message(const Region& region) {
  geometry_msgs::Polygon message;
  message.points.resize(region.size());
  for (std::size_t i = 0; i < region.size(); ++i) {
    message.points[i].x = static_cast<float>(region[i].x());
    message.points[i].y = static_cast<float>(region[i].y());
    message.points[i].z = static_cast<float>(region[i].z());
  }
  return message;
}

ToolPath to_path(const ToolMotion& motion, bool at_end_only,
                 const Eigen::Isometry3d& T_target_source) {
  const ShaftAxis end{T_target_source * to_eigen(motion.trocar),
                      T_target_source * to_eigen(motion.tip)};
  if (at_end_only) return {{0.0, end}};
  const ShaftAxis start{T_target_source * to_eigen(motion.previous_trocar),
                        T_target_source * to_eigen(motion.previous_tip)};
  return {{0.0, start}, {1.0, end}};
}

}  // namespace organ_collision
