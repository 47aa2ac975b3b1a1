#include "leg_motion.hpp"

#include <algorithm>
#include <cmath>

#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

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

/// How far a vector that is carried along is from where it was, when `share` of a turn is done.
Vector3d displacement(const ShaftArc& arc, double share) {
  const double angle = arc.turn.norm();
  const Vector3d axis = arc.turn.stableNormalized();
  const Vector3d across = axis.cross(arc.arm), outward = across.cross(axis);
  const double half = std::sin(0.5 * share * angle);
  return std::sin(share * angle) * across - 2.0 * half * half * outward;
}

}  // namespace

Eigen::Quaterniond least_rotation(const Vector3d& from, const Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Vector3d ShaftArc::beside_line(double time) const {
  if (turn.isZero(0.0) || time == 0.0 || time == 1.0) return Vector3d::Zero();
  return displacement(*this, time) - time * displacement(*this, 1.0);
}

ShaftArc ShaftArc::part(double begin, double end) const {
  return {(end - begin) * turn, arm + displacement(*this, begin)};
}

double ShaftMotion::deviation() const { return std::max(arcs[0].deviation(), arcs[1].deviation()); }

ShaftArc EndCarrier::arc_to(const EndCarrier& next) const {
  const Eigen::AngleAxisd turn(next.orientation * orientation.conjugate());
  return {turn.angle() * turn.axis(), arm};
}

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
      arm_(longest_arm(core, motion)),
      deviation_(motion.chord_deviation(arm_)) {}

ConvexCore CoreMotion::at(double time) const {
  if (time == 0.0) return start_;
  if (time == 1.0) return end_;
  if (link_) return link_->at(time) * in_link_;
  if (deviation_ == 0.0) return ShaftMotion{start_.axis(), end_.axis()}.at(time);
  return ShaftMotion{start_.axis(), end_.axis(), arcs_}.at(time);
}

double CoreMotion::farthest_move() const {
  if (link_) return link_->origin_displacement() + arm_ * link_->angle();
  // The speed of an arc differs from its mean by at most half of its acceleration.
  return std::max((end_.points[0] - start_.points[0]).norm(),
                  (end_.points[1] - start_.points[1]).norm()) +
         4.0 * deviation_;
}

double CoreMotion::chord_deviation(double duration) const {
  return duration * duration * deviation_;
}

double CoreMotion::chord_deviation(double duration, const Eigen::Vector3d& normal) const {
  return chord_deviation(duration) * (link_ ? link_->axis().cross(normal).norm() : 1.0);
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
