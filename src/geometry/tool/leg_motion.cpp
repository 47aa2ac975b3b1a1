#include "leg_motion.hpp"

#include <algorithm>

namespace organ_collision {
namespace {

/// Replaces the linear part of a pose by the nearest rotation, so that the link keeps its size.
Eigen::Isometry3d orthonormal(Eigen::Isometry3d pose) {
  pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return pose;
}

/// [m] An upper bound of the distance of the core's points from the axis of the link's rotation.
double longest_arm(const ConvexCore& core, const RigidMotion& motion) {
  double arm = 0.0;
  if (motion.angle() == 0.0) return arm;
  for (std::size_t i = 0; i < core.count; ++i) arm = std::max(arm, motion.arm(core.points[i]));
  return arm + core.rim.col(0).norm();
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

CoreMotion::CoreMotion(const ConvexCore& core, const RigidMotion& motion)
    : start_(motion.start() * core),
      end_(motion.end() * core),
      in_link_(core),
      link_(&motion),
      arm_(longest_arm(core, motion)) {}

ConvexCore CoreMotion::at(double time) const {
  if (time == 0.0) return start_;
  if (time == 1.0) return end_;
  if (link_) return link_->at(time) * in_link_;
  return ShaftMotion{start_.axis(), end_.axis()}.at(time);
}

double CoreMotion::farthest_move() const {
  if (link_) return link_->origin_displacement() + arm_ * link_->angle();
  return std::max((end_.points[0] - start_.points[0]).norm(),
                  (end_.points[1] - start_.points[1]).norm());
}

double CoreMotion::chord_deviation(double duration) const {
  if (!link_) return 0.0;
  // A curve deviates from its chord by at most an eighth of its acceleration, arm * angle^2.
  const double angle = duration * link_->angle();
  return arm_ * angle * angle / 8.0;
}

double CoreMotion::chord_deviation(double duration, const Eigen::Vector3d& normal) const {
  return link_ ? link_->axis().cross(normal).norm() * chord_deviation(duration) : 0.0;
}

double CoreMotion::largest_coordinate() const {
  double largest = 0.0;
  for (const ConvexCore* core : {&start_, &end_}) {
    for (std::size_t i = 0; i < core->count; ++i) {
      largest = std::max(largest, core->points[i].cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

}  // namespace organ_collision
