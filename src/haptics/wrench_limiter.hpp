#pragma once

#include <Eigen/Core>
#include <chrono>
#include <optional>
#include <vector>

#include "proxy_forces.hpp"

namespace organ_collision {

/// What the force on a hand, and the torque about the tool's centre, must not exceed.
struct WrenchLimits {
  double force, torque;            ///< [N], [N m]
  double force_rate, torque_rate;  ///< [N/s], [N m/s]; kUnlimited: no limit
};

/// Limits the force and the torque on a hand, and how fast both change, whatever the reason: tissue
/// that appears, slips or is removed, a jump of the hand or of a frame, another stiffness, answers
/// that end. Force and torque each go straight from the published value to the present one. The
/// torque is that about the tool's centre, so that a motion of the tool is no change of it.
class WrenchLimiter {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The longest time that counts in a step, so that a hand that was silent for long gets no jump.
  static constexpr std::chrono::milliseconds kLongestStep{2};
  /// A limit of force or torque that is lowered holds after this time, whatever the rates are. If
  /// they are kUnlimited, it holds at once.
  static constexpr std::chrono::milliseconds kLowering{8};

  /// Returns the forces to publish at `now`, and keeps them. `target`: the present forces; empty:
  /// no force. If the target exceeds a limit, all of it shrinks by one factor. An organ that is not
  /// in the target any more stays until its force is zero.
  ///
  /// While the force of an organ is on its way, its faces bear the part of it that has the
  /// direction of the target: they bear nothing where the tool has left the tissue. The rest acts
  /// at the tool's centre.
  const std::vector<OrganForce>& follow(std::vector<OrganForce> target, const WrenchLimits& limits,
                                        Time now);
  /// Whether the published forces are not yet the target's, or the target may have changed.
  bool is_on_its_way() const { return is_on_its_way_; }
  /// The target may have changed: makes is_on_its_way() true if there is a force.
  void expect_change();
  /// The forces that were published last.
  const std::vector<OrganForce>& forces() const { return forces_; }
  /// The parameter whose limit reduced the target. Null: no limit reduced it.
  const char* clipped_by() const { return clipped_by_; }
  /// Rotates force and torque into another frame.
  void rotate(const Eigen::Matrix3d& R_new_old);

 private:
  void clip(std::vector<OrganForce>& target, const WrenchLimits& limits);
  void go_towards(std::vector<OrganForce>& target, const WrenchLimits& limits,
                  double seconds) const;
  void lower(std::vector<OrganForce>& forces, const WrenchLimits& limits, Time now);

  std::vector<OrganForce> forces_;
  bool is_on_its_way_ = false;
  const char* clipped_by_ = nullptr;
  std::optional<Time> last_;
  WrenchLimits limits_{};                              ///< of the last step
  Time lowered_;                                       ///< when a limit was lowered
  double lowered_force_ = 0.0, lowered_torque_ = 0.0;  ///< the magnitudes at that time
};

}  // namespace organ_collision
