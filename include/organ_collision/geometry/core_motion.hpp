#pragma once

#include "organ_collision/geometry/convex_core.hpp"
#include "organ_collision/geometry/rigid_motion.hpp"
#include "organ_collision/geometry/shaft.hpp"

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
  /// this from the straight and even way between its ends: the speed's direction turns by the
  /// link's angle, and a curve leaves its chord by an eighth of its greatest acceleration.
  double bend(double duration) const;

 private:
  ConvexCore start_, end_;
  ConvexCore in_link_;
  const RigidMotion* link_ = nullptr;
  double reach_ = 0.0;  ///< [m] of the core from the link's origin
};

}  // namespace organ_collision
