#pragma once

#include <Eigen/Geometry>

#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// The smallest rotation that turns the direction of one vector into that of another. Neither may
/// be zero. Eigen's function would compile a singular value decomposition in each of its callers.
Eigen::Quaterniond least_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// One leg of a link's path, in the organ's frame [m]. The link moves as its chain of joints does.
/// Without a chain, its origin moves linearly, and it turns about a fixed direction at constant
/// speed, by at most half a turn (slerp).
class RigidMotion {
 public:
  /// `start`, `end`: T_organ_link at both ends of the leg. The rotations of `joints` are those of
  /// `start` and `end`. What its places there differ is added in proportion to the time.
  RigidMotion(const Eigen::Isometry3d& start, const Eigen::Isometry3d& end,
              ChainMotion joints = {});

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
  /// [rad] The angle from start to end, in [0, pi].
  double angle() const { return angle_; }
  /// The axis of the rotation from start to end: unit, in the organ's frame.
  Eigen::Vector3d axis() const { return start_.linear() * axis_; }

  /// [m] Upper bounds, for the points of a ball around a point of the link, of how far they move,
  /// and of how far they deviate from their chords. See doc/theory/geometry.md, Rims and chord
  /// deviation.
  double farthest_move(const Eigen::Vector3d& p_link, double radius) const;
  double chord_deviation(const Eigen::Vector3d& p_link, double radius = 0.0) const;
  /// [m] The same for the points of a box in the link's frame.
  double chord_deviation(const OrientedBox& box) const;
  /// [1] An upper bound of the share of a chord deviation that is along `normal` (unit).
  double share_along(const Eigen::Vector3d& normal) const {
    return joints_.chain ? 1.0 : axis().cross(normal).norm();
  }

 private:
  /// [m] The distance of a point, given in the link's frame, from the axis of the rotation. This
  /// axis passes through the link's origin.
  double arm(const Eigen::Vector3d& p_link) const { return axis_.cross(p_link).norm(); }

  Eigen::Isometry3d start_, end_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ();  ///< of the rotation: unit, in the link's frame
  double angle_ = 0.0;
  Eigen::Matrix3d mid_orientation_;
  ChainMotion joints_;
  Eigen::Vector3d off_start_ = Eigen::Vector3d::Zero();  ///< [m] from the chain's place to start_
  Eigen::Vector3d off_end_ = Eigen::Vector3d::Zero();
};

/// One leg of the path of a part's core, in the organ's frame [m]. If the core is the axis of a
/// shaft, its ends move linearly or on arcs. If it belongs to a link, it moves rigidly with the
/// link.
class CoreMotion {
 public:
  // The core of a shaft. NOLINTNEXTLINE(google-explicit-constructor)
  CoreMotion(const ShaftMotion& shaft)
      : start_(shaft.start), end_(shaft.end), arcs_(shaft.arcs), deviation_(shaft.deviation()) {}
  /// `core` is in the link's frame. `motion` must outlive this object.
  CoreMotion(const ConvexCore& core, const RigidMotion& motion);

  const ConvexCore& start() const { return start_; }
  const ConvexCore& end() const { return end_; }
  /// The core at `time` in [0, 1] of the leg.
  ConvexCore at(double time) const;

  /// The motion of the link; null if the core is the axis of a shaft.
  const RigidMotion* link() const { return link_; }
  /// [m] An upper bound of how far any point of the core moves during the leg.
  double farthest_move() const;
  /// [m] An upper bound of how far any point of the core deviates, along `normal` (unit), from
  /// linear motion between its places at the start and at the end of an interval. `duration`, in
  /// [0, 1] of the leg, is the length of the interval. See doc/theory/geometry.md, Rims and chord
  /// deviation.
  double chord_deviation(double duration, const Eigen::Vector3d& normal) const;
  /// [m] An upper bound of this deviation in any direction.
  double chord_deviation(double duration) const;
  /// [m] The largest absolute coordinate of the core's points at both ends of the leg. The rim of a
  /// cylinder is not considered.
  double largest_coordinate() const;

 private:
  ConvexCore start_, end_;
  ShaftArcs arcs_;  ///< how the ends of a shaft's axis move
  ConvexCore in_link_;
  const RigidMotion* link_ = nullptr;
  double move_ = 0.0;       ///< [m] farthest_move() of the core of a link
  double deviation_ = 0.0;  ///< [m] chord_deviation() of the whole leg
};

}  // namespace organ_collision
