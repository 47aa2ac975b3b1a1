#include "wrench_limiter.hpp"

#include <algorithm>
#include <utility>

#include "haptic_proxy_parameters.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] A load that exceeds a limit by this share is within it: it was scaled down to the limit.
constexpr double kRounding = 1e-12;

const OrganForce* find(const std::vector<OrganForce>& forces, const std::string& organ) {
  const auto found = std::find_if(forces.begin(), forces.end(),
                                  [&](const OrganForce& force) { return force.organ == organ; });
  return found == forces.end() ? nullptr : &*found;
}

/// A share of the way from one load to another, which it reaches exactly.
Vector3d between(const Vector3d& from, const Vector3d& to, double share) {
  return share == 1.0 ? to : Vector3d(from + share * (to - from));
}

/// The factor for the forces on an organ's faces, if `force` is published instead of that of the
/// `target`. It is above 1 while the force falls, unless faces that press against each other would
/// bear far more than the force.
double share_of_faces(const Vector3d& force, const OrganForce& target) {
  constexpr double kMost = 4.0;
  const double part = force.dot(target.force), whole = target.force.squaredNorm();
  if (!(part > 0.0 && whole > 0.0)) return 0.0;
  double on_faces = 0.0;
  for (const FaceForce& at : target.on_faces) on_faces += at.force.norm();
  return std::min(part / whole, std::max(1.0, kMost * force.norm() / on_faces));
}

}  // namespace

const std::vector<OrganForce>& WrenchLimiter::follow(std::vector<OrganForce> target,
                                                     const WrenchLimits& limits, Time now) {
  const auto passed = last_ ? now - *last_ : Time::duration(0);
  const std::chrono::duration<double> counted = std::min<Time::duration>(passed, kLongestStep);
  last_ = now;
  for (const OrganForce& before : forces_) {
    if (before.is_zero() || find(target, before.organ)) continue;
    target.push_back({before.organ, before.frame, before.topology});
  }
  clip(target, limits);
  std::vector<OrganForce> next = target;
  go_towards(next, limits, counted.count());
  lower(next, limits, now);
  is_on_its_way_ = false;
  for (std::size_t i = 0; i < next.size(); ++i) {
    OrganForce& of_organ = next[i];
    if (of_organ.force == target[i].force && of_organ.torque == target[i].torque) continue;
    is_on_its_way_ = true;
    const double share = share_of_faces(of_organ.force, target[i]);
    if (share == 0.0) of_organ.on_faces.clear();
    for (FaceForce& at : of_organ.on_faces) at.force *= share;
  }
  forces_ = std::move(next);
  return forces_;
}

/// Shrinks a target that exceeds a limit.
void WrenchLimiter::clip(std::vector<OrganForce>& target, const WrenchLimits& limits) {
  const double of_force = share_within_limit(force_of(target), limits.force);
  const double of_torque = share_within_limit(torque_of(target), limits.torque);
  clipped_by_ = of_torque < of_force ? names::kMaxTorque : names::kMaxForce;
  const double share = std::min(of_force, of_torque);
  if (share == 1.0) clipped_by_ = nullptr;
  for (OrganForce& of_organ : target) of_organ.scale(share);
}

/// Replaces the wrenches of the target by those that can be reached in a time.
void WrenchLimiter::go_towards(std::vector<OrganForce>& target, const WrenchLimits& limits,
                               double seconds) const {
  const Vector3d force = force_of(target) - force_of(forces_);
  const Vector3d torque = torque_of(target) - torque_of(forces_);
  const auto most = [seconds](double rate) { return rate == kUnlimited ? rate : rate * seconds; };
  const double of_force = share_within_limit(force, most(limits.force_rate));
  const double of_torque = share_within_limit(torque, most(limits.torque_rate));
  for (OrganForce& of_organ : target) {
    const OrganForce* before = find(forces_, of_organ.organ);
    const OrganForce nothing;
    if (!before) before = &nothing;
    of_organ.force = between(before->force, of_organ.force, of_force);
    of_organ.torque = between(before->torque, of_organ.torque, of_torque);
  }
}

/// Shrinks force and torque if a limit was lowered below them.
void WrenchLimiter::lower(std::vector<OrganForce>& forces, const WrenchLimits& limits, Time now) {
  if (limits.force < limits_.force || limits.torque < limits_.torque) {
    lowered_ = now;
    lowered_force_ = force_of(forces_).norm();
    lowered_torque_ = torque_of(forces_).norm();
  }
  limits_ = limits;
  const std::chrono::duration<double> passed = now - lowered_, whole = kLowering;
  const double left = std::clamp(1.0 - passed / whole, 0.0, 1.0);
  const auto shrink = [&](Vector3d OrganForce::*load, const Vector3d& sum, double limit,
                          double rate, double before) {
    const bool is_on_way = before > limit && rate != kUnlimited;
    const double most = is_on_way ? limit + left * (before - limit) : limit;
    const double share = share_within_limit(sum, most);
    if (share > 1.0 - kRounding) return;
    for (OrganForce& of_organ : forces) of_organ.*load *= share;
  };
  shrink(&OrganForce::force, force_of(forces), limits.force, limits.force_rate, lowered_force_);
  shrink(&OrganForce::torque, torque_of(forces), limits.torque, limits.torque_rate,
         lowered_torque_);
}

void WrenchLimiter::expect_change() {
  is_on_its_way_ =
      is_on_its_way_ || std::any_of(forces_.begin(), forces_.end(),
                                    [](const OrganForce& of_organ) { return !of_organ.is_zero(); });
}

void WrenchLimiter::rotate(const Eigen::Matrix3d& R_new_old) {
  for (OrganForce& of_organ : forces_) {
    of_organ.force = R_new_old * of_organ.force;
    of_organ.torque = R_new_old * of_organ.torque;
  }
}

}  // namespace organ_collision
