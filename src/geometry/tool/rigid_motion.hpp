#pragma once

#include <Eigen/Geometry>

namespace organ_collision {

/// One leg of a link's path, in the organ's frame [m]. The link's origin moves linearly. The link
/// turns about a fixed direction at constant speed, by at most half a turn (slerp).
class RigidMotion {
 public:
  /// T_organ_link at both ends of the leg.
  RigidMotion(const Eigen::Isometry3d& start, const Eigen::Isometry3d& end);

  const Eigen::Isometry3d& start() const { return start_; }
  const Eigen::Isometry3d& end() const { return end_; }
  /// T_organ_link at `time` in [0, 1] of the leg.
  Eigen::Isometry3d at(double time) const;
  /// The rotation in the middle of the leg: at(0.5).linear().
  const Eigen::Matrix3d& mid_orientation() const { return mid_orientation_; }

  /// Whether the link is at the same place at both ends of the leg.
  bool rests() const {
    return start_.linear() == end_.linear() && start_.translation() == end_.translation();
  }
  /// [rad] The angle by which the link turns, in [0, pi].
  double angle() const { return angle_; }
  /// The direction about which the link turns: unit, in the organ's frame.
  Eigen::Vector3d axis() const { return start_.linear() * axis_; }
  /// [m] Distance of a point in the link's frame from the axis of the rotation, which passes
  /// through the link's origin.
  double arm(const Eigen::Vector3d& p_link) const { return axis_.cross(p_link).norm(); }
  /// [m] How far the link's origin moves.
  double origin_displacement() const { return (end_.translation() - start_.translation()).norm(); }

 private:
  Eigen::Isometry3d start_, end_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ();  ///< unit, in the link's frame
  double angle_ = 0.0;
  Eigen::Matrix3d mid_orientation_;
};

}  // namespace organ_collision
