#pragma once

#include <Eigen/Core>
#include <vector>

namespace organ_collision {

/// Each three consecutive points are a triangle, with its outward normal by the right-hand rule.
using TrianglePoints = std::vector<Eigen::Vector3d>;

// The solid shapes of markers. Scales and poses are applied afterwards.

/// A cube around the origin, with edges of length 1.
const TrianglePoints& unit_cube();
/// A ball around the origin, with diameter 1.
const TrianglePoints& unit_sphere();
/// A cylinder along z around the origin, with length 1 and diameter 1.
const TrianglePoints& unit_cylinder();

/// The lengths of an arrow [m].
struct ArrowSize {
  double shaft_length, shaft_diameter, head_length, head_diameter;
};

/// An arrow from the origin along x.
TrianglePoints arrow(const ArrowSize& size);

}  // namespace organ_collision
