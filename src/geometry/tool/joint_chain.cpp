#include "organ_collision/geometry/tool/joint_chain.hpp"

#include <cstddef>

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// [1, m] Smaller motions of a joint are rounding errors.
constexpr double kResting = 1e-13;

bool rests(const Isometry3d& start, const Isometry3d& end) {
  return start.linear().isApprox(end.linear(), kResting) &&
         (start.translation() - end.translation()).norm() <= kResting;
}

}  // namespace

Joint::Joint(const Isometry3d& from, const Isometry3d& to)
    : start(from), step(to.translation() - from.translation()) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(from.linear().transpose() * to.linear()));
  axis = turn.axis();
  angle = turn.angle();
}

Isometry3d Joint::at(double time) const {
  Isometry3d pose = start;
  pose.translation() += time * step;
  if (angle > 0.0) pose.linear() *= Eigen::AngleAxisd(time * angle, axis).toRotationMatrix();
  return pose;
}

JointChain::JointChain(const std::vector<Isometry3d>& start, const std::vector<Isometry3d>& end)
    : tail_(Isometry3d::Identity()) {
  // A transform that rests becomes part of the joint behind it, which still moves as a joint.
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (rests(start[i], end[i])) {
      tail_ = tail_ * end[i];
    } else {
      joints_.emplace_back(tail_ * start[i], tail_ * end[i]);
      tail_.setIdentity();
    }
  }
}

Isometry3d JointChain::at(double time) const {
  Isometry3d pose = Isometry3d::Identity();
  for (const Joint& joint : joints_) pose = pose * joint.at(time);
  return pose * tail_;
}

Vector3d JointChain::place(const Vector3d& p_body, double time) const {
  Vector3d place = tail_ * p_body;
  for (auto joint = joints_.rbegin(); joint != joints_.rend(); ++joint) {
    if (joint->angle > 0.0) place = Eigen::AngleAxisd(time * joint->angle, joint->axis) * place;
    place = joint->start * place + time * joint->step;
  }
  return place;
}

double JointChain::angle() const {
  double angle = 0.0;
  for (const Joint& joint : joints_) angle += joint.angle;
  return angle;
}

bool JointChain::is_one_joint() const {
  return joints_.empty() || (joints_.size() == 1 && tail_.translation().isZero(kResting));
}

// The place q of a point in the frame of a joint moves with the speed v and the acceleration a. In
// the frame before, a joint that turns at the rate w adds w |k x q| to its speed, and w^2 |k x q| +
// 2 w v to its acceleration. At all times, |k x q| is at most its value half way plus v / 2.
ChainMotion::Bounds ChainMotion::bounds(const Vector3d& p_body, double radius) const {
  const double share = end - begin, half_way = 0.5 * (begin + end);
  Vector3d place = chain->tail_ * p_body;
  double speed = 0.0, acceleration = 0.0;
  for (auto joint = chain->joints_.rbegin(); joint != chain->joints_.rend(); ++joint) {
    const double rate = share * joint->angle;
    const double arm = joint->axis.cross(place).norm() + radius + 0.5 * speed;
    acceleration += rate * (rate * arm + 2.0 * speed);
    speed += rate * arm + share * joint->step.norm();
    place = joint->at(half_way) * place;
  }
  return {speed, acceleration / 8.0};
}

}  // namespace organ_collision
