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

}  // namespace

Eigen::Quaterniond least_rotation(const Vector3d& from, const Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

ShaftArc::ShaftArc(const ChainMotion& body, const Vector3d& p_body)
    : body_(body),
      p_body_(p_body),
      start_(body.place(p_body, 0.0)),
      end_(body.place(p_body, 1.0)),
      deviation_(body.bounds(p_body, 0.0).deviation) {}

Vector3d ShaftArc::beside_line(double time) const {
  if (!body_.chain || time == 0.0 || time == 1.0) return Vector3d::Zero();
  return body_.place(p_body_, time) - start_ - time * (end_ - start_);
}

ShaftArc ShaftArc::part(double begin, double end) const {
  return body_.chain ? ShaftArc(body_.part(begin, end), p_body_) : ShaftArc();
}

double ShaftMotion::deviation() const { return std::max(arcs[0].deviation(), arcs[1].deviation()); }

RigidMotion::RigidMotion(const Eigen::Isometry3d& start, const Eigen::Isometry3d& end,
                         ChainMotion joints)
    : start_(orthonormal(start)),
      end_(orthonormal(end)),
      mid_orientation_(start_.linear()),
      joints_(std::move(joints)) {
  if (joints_.chain) {
    off_start_ = start_.translation() - joints_.at(0.0).translation();
    off_end_ = end_.translation() - joints_.at(1.0).translation();
    mid_orientation_ = at(0.5).linear();
  }
  if (start_.linear() == end_.linear()) return;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(start_.linear().transpose() * end_.linear()));
  axis_ = turn.axis();
  angle_ = turn.angle();
  if (!joints_.chain) mid_orientation_ = at(0.5).linear();
}

double RigidMotion::farthest_move(const Vector3d& p_link, double radius) const {
  if (!joints_.chain) {
    return (end_.translation() - start_.translation()).norm() + (arm(p_link) + radius) * angle_;
  }
  return joints_.bounds(p_link, radius).move + (off_end_ - off_start_).norm();
}

double RigidMotion::chord_deviation(const Vector3d& p_link, double radius) const {
  if (joints_.chain) return joints_.bounds(p_link, radius).deviation;
  return (arm(p_link) + radius) * angle_ * angle_ / 8.0;
}

double RigidMotion::chord_deviation(const OrientedBox& box) const {
  if (joints_.chain) return chord_deviation(box.center, box.half_size.norm());
  if (angle_ == 0.0) return 0.0;
  double arms = 0.0;
  for (int i = 0; i < 3; ++i) arms += box.half_size[i] * arm(box.axes.col(i));
  return chord_deviation(box.center, arms);
}

Eigen::Isometry3d RigidMotion::at(double time) const {
  if (time == 0.0) return start_;
  if (time == 1.0) return end_;
  if (joints_.chain) {
    Eigen::Isometry3d pose = joints_.at(time);
    pose.translation() += off_start_ + time * (off_end_ - off_start_);
    return pose;
  }
  Eigen::Isometry3d pose;
  pose.translation() = start_.translation() + time * (end_.translation() - start_.translation());
  pose.linear() = start_.linear() * Eigen::AngleAxisd(time * angle_, axis_).toRotationMatrix();
  pose.makeAffine();
  return pose;
}

CoreMotion::CoreMotion(const ConvexCore& core, const RigidMotion& motion)
    : start_(motion.start() * core), end_(motion.end() * core), in_link_(core), link_(&motion) {
  const double rim = core.rim.col(0).norm();
  for (std::size_t i = 0; i < core.count; ++i) {
    move_ = std::max(move_, motion.farthest_move(core.points[i], rim));
    deviation_ = std::max(deviation_, motion.chord_deviation(core.points[i], rim));
  }
}

ConvexCore CoreMotion::at(double time) const {
  if (time == 0.0) return start_;
  if (time == 1.0) return end_;
  if (link_) return link_->at(time) * in_link_;
  if (deviation_ == 0.0) return ShaftMotion{start_.axis(), end_.axis()}.at(time);
  return ShaftMotion{start_.axis(), end_.axis(), arcs_}.at(time);
}

double CoreMotion::farthest_move() const {
  if (link_) return move_;
  // The speed of an arc differs from its mean by at most half of its acceleration.
  return std::max((end_.points[0] - start_.points[0]).norm(),
                  (end_.points[1] - start_.points[1]).norm()) +
         4.0 * deviation_;
}

double CoreMotion::chord_deviation(double duration) const {
  return duration * duration * deviation_;
}

double CoreMotion::chord_deviation(double duration, const Eigen::Vector3d& normal) const {
  return chord_deviation(duration) * (link_ ? link_->share_along(normal) : 1.0);
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
