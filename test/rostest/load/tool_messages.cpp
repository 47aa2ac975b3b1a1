#include "tool_messages.hpp"

#include <string>

namespace organ_collision::stress {
namespace {

geometry_msgs::TransformStamped transform(const std::string& frame, ros::Time stamp,
                                          const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "sheet";
  transform.header.stamp = stamp;
  transform.child_frame_id = frame;
  transform.transform.translation.x = pose.translation().x();
  transform.transform.translation.y = pose.translation().y();
  transform.transform.translation.z = pose.translation().z();
  transform.transform.rotation.x = rotation.x();
  transform.transform.rotation.y = rotation.y();
  transform.transform.rotation.z = rotation.z();
  transform.transform.rotation.w = rotation.w();
  return transform;
}

Eigen::Isometry3d at(const Eigen::Vector3d& point) {
  return Eigen::Isometry3d(Eigen::Translation3d(point));
}

}  // namespace

std::vector<geometry_msgs::TransformStamped> resting_transforms(ros::Time stamp) {
  return {transform("probe_trocar", stamp, at(kProbeTrocar)),
          transform("needle_trocar", stamp, at(kNeedleTrocar)),
          transform("stylus_trocar", stamp, at(kStylusTrocar))};
}

std::vector<geometry_msgs::TransformStamped> moving_transforms(const ToolPlaces& places,
                                                               ros::Time stamp) {
  return {transform("probe_tip", stamp, at(places.probe_tip)),
          transform("needle_tip", stamp, at(places.needle_tip)),
          transform("jaw", stamp, places.jaw)};
}

geometry_msgs::PoseStamped stylus_pose(const ToolPlaces& places, ros::Time stamp) {
  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = "sheet";
  pose.header.stamp = stamp;
  pose.pose.position.x = places.stylus_tip.x();
  pose.pose.position.y = places.stylus_tip.y();
  pose.pose.position.z = places.stylus_tip.z();
  pose.pose.orientation.w = 1.0;
  return pose;
}

}  // namespace organ_collision::stress
