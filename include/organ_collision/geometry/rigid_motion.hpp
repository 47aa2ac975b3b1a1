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
  /// [m] How far the link's origin moves.
  double way() const { return (end_.translation() - start_.translation()).norm(); }

 private:
  Eigen::Isometry3d start_, end_;
  Eigen::Vector3d axis_;  ///< unit, in the link's frame
  double angle_;
  Eigen::Matrix3d half_way_;
};

}  // namespace organ_collision
