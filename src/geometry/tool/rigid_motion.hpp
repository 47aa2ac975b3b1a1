#pragma once

#include <Eigen/Geometry>

namespace organ_collision {

/// One leg of a link's way, in the organ's frame [m]: its origin moves linearly, its orientation
/// turns about one axis at constant speed, the shorter way round (slerp).
class RigidMotion {
 public:
  /// T_organ_link at both ends of the leg.
  RigidMotion(const Eigen::Isometry3d& start, const Eigen::Isometry3d& end);

  const Eigen::Isometry3d& start() const { return start_; }
  const Eigen::Isometry3d& end() const { return end_; }
  /// T_organ_link at `time` in [0, 1] of the leg.
  Eigen::Isometry3d at(double time) const;
  /// at(0.5).linear()
  const Eigen::Matrix3d& half_way() const { return half_way_; }

  /// [rad] By how much the link turns, in [0, pi].
  double angle() const { return angle_; }
  /// Unit, in the organ's frame: what it turns about, all the time.
  Eigen::Vector3d axis() const { return start_.linear() * axis_; }
  /// How far a point in the link's frame is from that axis through the link's origin.
  double arm(const Eigen::Vector3d& p_link) const { return axis_.cross(p_link).norm(); }
  /// [m] How far the link's origin moves.
  double way() const { return (end_.translation() - start_.translation()).norm(); }

 private:
  Eigen::Isometry3d start_, end_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ();  ///< unit, in the link's frame
  double angle_ = 0.0;
  Eigen::Matrix3d half_way_;
};

}  // namespace organ_collision
