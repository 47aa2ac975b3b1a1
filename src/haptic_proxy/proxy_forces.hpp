#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <optional>
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

/// The sum of the forces of all organs on the hand [N].
Eigen::Vector3d sum_of(const std::vector<OrganForce>& forces);

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

/// Limits how fast the force on the hand changes, whatever the reason: tissue that appears, slips
/// or is removed, a jump of a frame, another stiffness, answers that end. The published forces go
/// straight to the present ones, by at most rate * time in a step. The torque about the tool's
/// centre, divided by the tool's size, is limited in the same way.
class ForceRateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The longest time that counts in a step, so that a hand that was silent for long gets no jump.
  static constexpr std::chrono::milliseconds kLongestStep{2};

  /// Returns the forces to publish at `now`, and keeps them. `target`: the present forces; empty:
  /// no force. `rate` [N/s]. `center` [m]: that of the tool, in the proxy's frame. `size` [m]: of a
  /// free tool; 0: the force acts at the centre.
  const std::vector<OrganForce>& follow(const std::vector<OrganForce>& target, double rate,
                                        const Eigen::Vector3d& center, double size, Time now);
  /// Whether the published forces are not yet the target's.
  bool is_on_its_way() const { return is_on_its_way_; }
  /// The forces that were published last.
  const std::vector<OrganForce>& forces() const { return forces_; }
  /// Rotates the forces into another frame.
  void rotate(const Eigen::Matrix3d& R_new_old);

 private:
  std::vector<OrganForce> forces_;
  bool is_on_its_way_ = false;
  std::optional<Time> last_;
};

}  // namespace organ_collision
