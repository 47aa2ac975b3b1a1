#pragma once

#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "rigid_motion.hpp"

namespace organ_collision {

/// One leg of the way of a part's core, in the organ's frame [m]: a shaft's axis, whose ends move
/// linearly, or a link's core, which moves rigidly.
class CoreMotion {
 public:
  // An axis is a core. NOLINTNEXTLINE(google-explicit-constructor)
  CoreMotion(const ShaftMotion& shaft) : start_(shaft.start), end_(shaft.end) {}
  /// `core` in the link's frame. `motion` must outlive this.
  CoreMotion(const ConvexCore& core, const RigidMotion& motion);

  const ConvexCore& start() const { return start_; }
  const ConvexCore& end() const { return end_; }
  /// The core at `time` in [0, 1] of the leg.
  ConvexCore at(double time) const;

  /// How the link moves; null: the core is a shaft's axis.
  const RigidMotion* link() const { return link_; }
  /// [m] No point of the core moves farther than this.
  double farthest_move() const;
  /// [m] No point's way between two times, `duration` in [0, 1] of the leg apart, is farther than
  /// this from the straight and even way between its ends, along `normal`: a curve leaves its chord
  /// by at most an eighth of its greatest acceleration, at right angles to the turning axis.
  double bend(double duration, const Eigen::Vector3d& normal) const;
  /// The same along any direction.
  double bend(double duration) const;

 private:
  ConvexCore start_, end_;
  ConvexCore in_link_;
  const RigidMotion* link_ = nullptr;
  double arm_ = 0.0;  ///< [m] the core's farthest from the turning axis
};

}  // namespace organ_collision
