#include "rigid_motion.hpp"

namespace organ_collision {
namespace {

/// Makes the linear part an exact rotation; otherwise the link would change its size on its path.
Eigen::Isometry3d orthonormal(Eigen::Isometry3d pose) {
  pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return pose;
}

}  // namespace

RigidMotion::RigidMotion(const Eigen::Isometry3d& start, const Eigen::Isometry3d& end)
    : start_(orthonormal(start)), end_(orthonormal(end)), mid_orientation_(start_.linear()) {
  if (start_.linear() == end_.linear()) return;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(start_.linear().transpose() * end_.linear()));
  axis_ = turn.axis();
  angle_ = turn.angle();
  mid_orientation_ = at(0.5).linear();
}

Eigen::Isometry3d RigidMotion::at(double time) const {
  if (time == 0.0) return start_;
  if (time == 1.0) return end_;
  Eigen::Isometry3d pose;
  pose.translation() = start_.translation() + time * (end_.translation() - start_.translation());
  pose.linear() = start_.linear() * Eigen::AngleAxisd(time * angle_, axis_).toRotationMatrix();
  pose.makeAffine();
  return pose;
}

}  // namespace organ_collision
