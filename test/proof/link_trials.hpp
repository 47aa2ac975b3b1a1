#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/convex_core.hpp"
#include "trials.hpp"

namespace organ_collision::oracle {

/// A part of a link that moves past a face. The corners of the face are 32-bit floats [m].
struct LinkTrial {
  ConvexCore core;  ///< in the link's frame
  Eigen::Isometry3d start, end;
  Triangle face;
  double radius;

  RigidMotion motion() const { return {start, end}; }
};

/// The kinds of convex cores that links have: ball, triangle of a mesh, box, cylinder.
constexpr std::size_t kCoreKinds = 4;
/// A core of this kind, about 1e-4 to 0.1 m large and within 0.1 m of the link's origin. Some cores
/// are flat or long.
ConvexCore make_core(std::size_t core_kind, Random& random);

/// Names of the kinds of trials, by the relative position of face and core.
const std::vector<std::string>& link_trial_kinds();

/// A trial of this kind. The link does not rotate, or by angles from 1e-6 to nearly pi [rad].
LinkTrial make_link_trial(std::size_t kind, std::size_t core_kind, Random& random);

/// A pose within `away` [m] of the origin along each axis, with any orientation.
Eigen::Isometry3d random_pose(double away, Random& random);
/// A rotation by `angle` [rad] about a random axis.
Eigen::Matrix3d random_turn(double angle, Random& random);

/// The pose at a time in [0, 1]: the origin moves linearly, and the orientation is interpolated by
/// quaternions.
Eigen::Isometry3d between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double time);

/// The rounding error of doubles [m]: a few roundings of the largest coordinate.
double rounding(const LinkTrial& trial);

// Both print with 17 digits.
std::ostream& operator<<(std::ostream& out, const ConvexCore& core);
std::ostream& operator<<(std::ostream& out, const LinkTrial& trial);

}  // namespace organ_collision::oracle
