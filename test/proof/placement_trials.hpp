#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/surface_topology.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "trials.hpp"

namespace organ_collision::oracle {

/// An axis and a closed organ of a few faces, 1e-3 to 1 m large: a tetrahedron, a box on a lattice,
/// a dented ball, a torus, a ball with a cavity, two bodies that touch in a corner or overlap, or a
/// body with collapsed faces. Some organs look inward, or are a kilometre away.
struct PlacementTrial {
  TriangleMesh organ;
  SurfaceTopology topology;
  /// The faces between welded vertices. In some organs each face has vertices of its own, which are
  /// up to 1e-6 m apart from those that they are welded to.
  std::vector<Triangle> faces;
  ShaftAxis axis;
};

/// Names of the kinds of trials, by what the axis is aimed at.
const std::vector<std::string>& placement_trial_kinds();

/// A trial of this kind. The axis passes through its aim, or ends there. In about half of the
/// trials it does so exactly. In the others it is off by 1e-3 to 1e-12 of the organ's size.
PlacementTrial make_placement_trial(std::size_t kind, Random& random);

/// Prints the whole trial with 17 digits.
std::ostream& operator<<(std::ostream& out, const PlacementTrial& trial);

}  // namespace organ_collision::oracle
