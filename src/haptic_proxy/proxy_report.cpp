#include "proxy_report.hpp"

#include <tf2_eigen/tf2_eigen.h>

namespace organ_collision {

geometry_msgs::Pose pose_of(const ToolParameters& tool, const ToolPose& pose) {
  if (!tool.has_shaft()) return tf2::toMsg(pose.links.front());
  Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
  tip.translation() = pose.axis.tip;
  tip.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), pose.axis.tip - pose.axis.trocar)
          .toRotationMatrix();
  return tf2::toMsg(tip);
}

}  // namespace organ_collision
