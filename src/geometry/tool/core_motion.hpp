#pragma once

#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "rigid_motion.hpp"

namespace organ_collision {

/// One leg of the path of a part's core, in the organ's frame [m]. The core is the axis of a shaft,
/// whose ends move linearly, or belongs to a link, which moves rigidly.
class CoreMotion {
 public:
  // An axis is a core. NOLINTNEXTLINE(google-explicit-constructor)
  CoreMotion(const ShaftMotion& shaft) : start_(shaft.start), end_(shaft.end) {}
  /// `core` is in the link's frame. `motion` must outlive this object.
  CoreMotion(const ConvexCore& core, const RigidMotion& motion);

  const ConvexCore& start() const { return start_; }
  const ConvexCore& end() const { return end_; }
  /// The core at `time` in [0, 1] of the leg.
  ConvexCore at(double time) const;

  /// The motion of the link; null if the core is the axis of a shaft.
  const RigidMotion* link() const { return link_; }
  /// [m] An upper bound of how far any point of the core moves.
  double farthest_move() const;
  /// [m] An upper bound of how far any point of the core deviates, along `normal` (unit), from
  /// linear motion between its places at the start and at the end of an interval. `duration`, in
  /// [0, 1] of the leg, is the length of the interval. See doc/geometry.md, Rims and chord
  /// deviation.
  double chord_deviation(double duration, const Eigen::Vector3d& normal) const;
  /// The same along any direction.
  double chord_deviation(double duration) const;
  /// [m] The largest absolute coordinate of the core's points at both ends of the leg. The rim of a
  /// cylinder is left out.
  double largest_coordinate() const;

 private:
  ConvexCore start_, end_;
  ConvexCore in_link_;
  const RigidMotion* link_ = nullptr;
  double arm_ = 0.0;  ///< [m] upper bound of the distance of the core's points from the axis of
                      ///< the link's rotation, which passes through the link's origin
};

}  // namespace organ_collision
