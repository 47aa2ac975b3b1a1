#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "forces/forces.hpp"
#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision {

/// The force of one organ on the hand, and the forces at the organ's faces that it comes from.
struct OrganForce {
  std::string organ;
  std::string frame = {};      ///< the organ's frame; proxy_forces() does not set it
  std::uint32_t topology = 0;  ///< OrganMesh.topology of the shape that `on_faces` refers to
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the hand, in the proxy's frame
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] about the proxy frame's origin
  std::vector<FaceForce> on_faces = {};  ///< the tissue's forces on the proxy, in the organ's frame

  void scale(double factor);
};

/// Divides the force on the hand among the organs. Returns one OrganForce for each organ, in their
/// order. Together they are stiffness times pull plus `damping`, and the torque of this force. A
/// proxy that is still on its way may have no contact. Then all organs have the same share, and no
/// face bears it.
///
/// Each contact and crossing pushes with stiffness times its load. A shaft through a trocar is a
/// lever: a contact at the place contact.shaft acts on the tip with this share of its load. A
/// crossing does so only with the part of its load across the axis. The part along the axis acts in
/// full. The loads do not explain the damping, and the pull of a proxy that is still on its way.
/// These are divided among contacts and crossings in proportion to the loads. For a free tool, the
/// forces at the faces of an organ therefore add up to its force on the hand.
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

  /// [s] The time in which the share rises from 0 to 1.
  static constexpr double kDuration = 0.01;

  /// From `now` on, the share rises or falls. Return the share at `now`.
  double rise(Time now) { return turn(now, 1.0); }
  double fall(Time now) { return turn(now, -1.0); }
  /// The share in [0, 1] at the last call of rise() or fall().
  double share() const { return share_; }

 private:
  double turn(Time now, double direction);

  double share_ = 0.0;
  double direction_ = -1.0;  ///< 1: it rises; -1: it falls
  Time last_{};
};

}  // namespace organ_collision
