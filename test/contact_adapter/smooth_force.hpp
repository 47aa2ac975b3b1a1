#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "contact_adapter/force_law.hpp"
#include "force_trajectory.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {

constexpr double kStep = 1e-4;                       // [m] distance between poses of a trajectory
constexpr double kSeconds = 1e-3;                    // [s] duration of a step
constexpr double kCells[] = {0.02, 0.005, 0.00125};  // [m] sizes of the organ's grid cells

/// The package's force law, which remembers earlier answers. Its memory begins empty.
inline ForceOf remembering_law(const KeptSides::Radius& radius = kRadius) {
  return [radius, law = ForceLaw()](const ContactArray& answer) mutable {
    return to_eigen(wrench_of(law.follow(answer, kSeconds, kStiffness, radius)).force);
  };
}

/// Moves a shaft through `corners` and returns its forces. Expects no jump: from one pose to the
/// next, the force changes by at most 5 * kStiffness * the distance moved.
inline std::vector<ForceStep> expect_no_jump(const std::string& what, const TriangleMesh& organ,
                                             const std::vector<ShaftAxis>& corners) {
  const auto steps = forces_along(way_through(corners, kStep), organ, remembering_law());
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_LE(steps[i].change, 5.0 * kStiffness * steps[i].way)
        << what << ", step " << i << ", tip at " << steps[i].axis.tip.transpose() << ": force "
        << steps[i].force.transpose() << " after " << steps[i - 1].force.transpose();
  }
  return steps;
}

/// A shaft parallel to the y axis through (x, 0.003, z), except that its tip is lowered by `tilt`
/// [rad].
inline ShaftAxis lying(double x, double z, double tilt) {
  const Eigen::Vector3d middle(x, 0.003, z), along(0.0, 1.0, -tilt);
  return {middle - 0.05 * along, middle + 0.04 * along};
}

/// The angle between two vectors [rad].
inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace organ_collision
