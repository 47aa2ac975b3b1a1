#include "grasper_kinematics.hpp"

#include <cmath>

namespace grasper {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kJawAxis = 0.009;  // From the wrist.
constexpr double kTip = 0.029;      // Of the closed jaws, from the wrist.

Isometry3d turn(const Vector3d& axis, double angle) { return Isometry3d(AngleAxisd(angle, axis)); }
Isometry3d along_z(double distance) { return Isometry3d(Translation3d(0.0, 0.0, distance)); }

}  // namespace

Joints lowest() { return (Joints() << -1.2, -1.2, 0.0, -3.1, -1.4, 0.0).finished(); }
Joints highest() { return (Joints() << 1.2, 1.2, 0.25, 3.1, 1.4, 0.8).finished(); }

std::array<Isometry3d, 4> link_poses(const Isometry3d& trocar, const Joints& joints) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const Isometry3d shaft =
      trocar * turn(y, joints[0]) * turn(x, joints[1]) * along_z(joints[2]) * turn(z, joints[3]);
  const Isometry3d wrist = shaft * turn(x, joints[4]);
  const Isometry3d jaws = wrist * along_z(kJawAxis);
  return {shaft, wrist, jaws * turn(y, joints[5]), jaws * turn(z, kPi) * turn(y, joints[5])};
}

Vector3d tip(const Isometry3d& trocar, const Joints& joints) {
  return link_poses(trocar, joints)[1] * Vector3d(0.0, 0.0, kTip);
}

std::optional<Joints> joints_for(const Isometry3d& trocar, const Vector3d& point, double roll,
                                 double wrist, double jaw) {
  const Vector3d target = trocar.inverse() * point;
  // The tip in the frame that yaw and pitch turn: the wrist bends it away from the axis of the
  // shaft.
  const Vector3d bent =
      turn(Vector3d::UnitZ(), roll) * turn(Vector3d::UnitX(), wrist) * Vector3d(0.0, 0.0, kTip);
  const double depth_squared = target.squaredNorm() - bent.head<2>().squaredNorm();
  if (depth_squared < 0.0 || std::abs(bent.x()) > std::hypot(target.x(), target.z())) return {};
  const double depth = std::sqrt(depth_squared);
  // Pitch turns the tip to the height of the target, yaw turns it to the target.
  const double pitch =
      std::acos(target.y() / std::hypot(bent.y(), depth)) - std::atan2(depth, bent.y());
  const double ahead = bent.y() * std::sin(pitch) + depth * std::cos(pitch);
  const double yaw = std::atan2(target.x(), target.z()) - std::atan2(bent.x(), ahead);
  const Joints joints = (Joints() << yaw, pitch, depth - bent.z(), roll, wrist, jaw).finished();
  const bool is_legal =
      (joints.array() >= lowest().array()).all() && (joints.array() <= highest().array()).all();
  return is_legal ? std::optional(joints) : std::nullopt;
}

}  // namespace grasper
