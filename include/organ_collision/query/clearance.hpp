#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace organ_collision {

/// What is known of the distance between a tool and an organ. The values are those of
/// msg/Clearance.msg.
enum class ClearanceState : std::uint8_t {
  kNotAsked = 0,
  kBeyondMargin = 1,  ///< no face was found within the margin at the end of the step
  kKnown = 2
};

/// The distance between the surfaces of a tool and an organ, with the fields of msg/Clearance.msg.
/// (The message's C++ type is already called organ_collision::Clearance.) Lengths are in metres,
/// points and vectors in the organ's frame.
///
/// The core is a shaft's axis, the centre of a sphere, or a solid or surface link itself. The
/// distance is the smallest one between a face and a core, minus the radius around that core. It is
/// negative if a shaft or a sphere touches. The margin is never subtracted from the distance. Only
/// the contacts tell whether the tool passed through tissue.
///
/// `distance` is exact to 1e-9 m. `least` is at most 1e-6 m above the smallest distance.
struct ToolClearance {
  /// What is known. If it is not kKnown, `is_resolved` is the only field below `margin` that is
  /// set. If `is_resolved` is then false, a face may be within the margin all the same.
  ClearanceState state = ClearanceState::kNotAsked;
  /// Whether the nearest face of the whole organ was looked for.
  bool unlimited = false;
  /// The margin that was asked for; 0 if `unlimited`.
  double margin = 0.0;
  /// The distance at the end of the step.
  double distance = 0.0;
  /// The smallest distance at any time of the step. In a static query it equals `distance`. If
  /// anything was touched during a swept step, it is 0, even if `distance` is negative.
  double least = 0.0;
  /// A time at which the distance is within 1e-6 m of `least`, as a fraction of the step in [0, 1].
  /// If anything was touched, it is the time of the first touch.
  double least_fraction = 0.0;
  /// The face with the nearest point at the end of the step.
  std::uint32_t face = 0;
  /// The indices of the face's corners among the organ's vertices, in the order of `barycentric`.
  std::array<std::uint32_t, 3> vertices = {};
  /// The number of the nearest link, from 0, or kShaft.
  std::int32_t link = 0;
  /// The barycentric coordinates of `on_organ` in `face`.
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  /// The nearest point of the organ.
  Eigen::Vector3d on_organ = Eigen::Vector3d::Zero();
  /// The nearest point of the core plus the radius times `normal`, so that
  /// on_organ - on_tool = distance * normal.
  Eigen::Vector3d on_tool = Eigen::Vector3d::Zero();
  /// The unit vector from the tool to the organ.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// False if core and face meet to within tolerance::kPierced. `normal` is then the face's normal
  /// or its opposite, as in FaceContact.
  bool normal_defined = false;
  /// [m/s] How fast `distance` shrinks at the end of the step, if the two points move as
  /// CollisionRequest::velocity_from and pose_before say. Negative: it grows. 0 in a static query,
  /// and without pose_before.
  double closing_speed = 0.0;
  /// False if the query reached its work limit before it had measured all faces: `distance` and
  /// `least` are then upper bounds. Also false if the first touch is an unresolved contact: `least`
  /// is then 0, but the tool may not touch at all.
  bool is_resolved = true;
};

}  // namespace organ_collision
