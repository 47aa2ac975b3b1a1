#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "forces/forces.hpp"
#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision {

/// What one organ does to the hand, and the proxy to the organ.
struct OrganForce {
  std::string organ;
  std::string frame = {};      ///< of the organ; proxy_forces() does not set it
  std::uint32_t topology = 0;  ///< of the shape that `on_faces` belongs to
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the hand, in the proxy's frame
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] of it about the frame's origin
  std::vector<FaceForce> on_faces = {};  ///< of the tissue on the proxy, in the organ's frame

  void scale(double factor);
};

/// The force on the hand divided among the organs, in their order. The sum over the organs is
/// stiffness times pull plus `damping`, and the torque that goes with it. A proxy that is still on
/// its way may have no contact: then all organs have the same share, and no face bears it.
///
/// Each contact and crossing pushes with stiffness times its load. In a tool through a trocar, the
/// load of a contact along the shaft acts on the tip with the lever of its place, contact.shaft.
/// The load of a crossing does so only across the axis; along the axis it acts whole.
/// What the loads do not explain is divided among the contacts in proportion to the loads: the
/// damping, and the pull of a proxy that is still on its way. For a free tool, the forces on the
/// faces of an organ therefore add up to its force on the hand.
///
/// `stiffness` in N/m; `damping`: a force on the hand [N].
std::vector<OrganForce> proxy_forces(const ProxyAnswer& answer,
                                     const std::vector<ProxyOrgan>& organs, ProxyFreedom freedom,
                                     bool has_shaft, double stiffness,
                                     const Eigen::Vector3d& damping);

/// The share of a force that is published. It rises and falls linearly in time, between 0 and 1
/// within kDuration, so that a force neither appears nor vanishes in a jump.
class ForceRamp {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// [s]
  static constexpr double kDuration = 0.01;

  /// From `now` on, the share rises or falls. Return the share at `now`.
  double rise(Time now) { return turn(now, 1.0); }
  double fall(Time now) { return turn(now, -1.0); }
  /// In [0, 1], at the time of the last call.
  double share() const { return share_; }

 private:
  double turn(Time now, double direction);

  double share_ = 0.0;
  double direction_ = -1.0;  ///< 1: it rises; -1: it falls
  Time last_{};
};

}  // namespace organ_collision
