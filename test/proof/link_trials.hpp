#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "geometry/tool/rigid_motion.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/convex_core.hpp"
#include "trials.hpp"

namespace organ_collision::oracle {

/// A part of a link that passes a face; the face's corners are 32-bit floats [m].
struct LinkTrial {
  ConvexCore core;  ///< in the link's frame
  Eigen::Isometry3d start, end;
  Triangle face;
  double radius;

  RigidMotion motion() const { return {start, end}; }
};

/// The convex cores that links have: a ball's, a triangle's of a mesh, a box's, a cylinder's.
constexpr std::size_t kCoreKinds = 4;
/// About 1e-4 to 0.1 m large, within 0.1 m of the link's origin; some are flat or long.
ConvexCore make_core(std::size_t core_kind, Random& random);

/// The kinds of trials: how face and core lie to each other.
const std::vector<std::string>& link_trial_kinds();

/// A trial of a kind. The link turns by nothing, nearly half a turn, and all angles from 1e-6
/// between.
LinkTrial make_link_trial(std::size_t kind, std::size_t core_kind, Random& random);

/// Within `away` [m] of the origin along each axis, any orientation.
Eigen::Isometry3d random_pose(double away, Random& random);
/// `angle` [rad] about any axis.
Eigen::Matrix3d random_turn(double angle, Random& random);

/// [m] What doubles lose: some roundings of the largest coordinate.
double rounding(const LinkTrial& trial);

/// All of a trial with 17 digits.
std::ostream& operator<<(std::ostream& out, const LinkTrial& trial);

}  // namespace organ_collision::oracle
