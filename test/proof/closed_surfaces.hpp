#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "trials.hpp"

namespace organ_collision::oracle {

/// A closed surface of some faces [m]. Its faces look outward or inward.
struct ClosedSurface {
  std::vector<Eigen::Vector3d> vertices;  ///< 32-bit floats
  std::vector<std::array<std::uint32_t, 3>> faces;
};

/// A random surface, 1e-3 to 1 m large: a tetrahedron, a box on a lattice, a dented ball, a torus,
/// a ball with a cavity, two bodies that touch in a corner or overlap, or a body with collapsed
/// faces. Some of them look inward, or are a kilometre away.
ClosedSurface make_closed_surface(Random& random);

/// The same surface with three vertices of its own for each face, as in an STL file.
ClosedSurface without_shared_vertices(const ClosedSurface& surface);

}  // namespace organ_collision::oracle
