#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision::bench {

/// A surface as a mesh message carries it.
struct OrganSurface {
  std::vector<float> vertices;           ///< x y z x y z ... [m]
  std::vector<std::uint32_t> triangles;  ///< three vertex indices a face, outward

  std::size_t face_count() const { return triangles.size() / 3; }
};

/// Corners of a face where its vertices are `vertices` now.
Triangle corners(const OrganSurface& organ, const std::vector<float>& vertices, std::size_t face);

/// 4 faces: a tetrahedron. 1224, 10 000, 100 000 or 1 000 000: a closed organ of a liver's size,
/// 0.2 m by 0.13 m by 0.07 m, its vertices ring by ring around the longest axis.
/// Throws std::invalid_argument for any other number.
OrganSurface make_organ(std::size_t faces);

/// The organ's vertices when it is bent by up to about 1 cm, which is the same for all phases, and
/// every vertex circles around that place with `amplitude` [m].
std::vector<float> deformed(const std::vector<float>& rest, double phase, double amplitude);

/// An order for the vertices and one for the faces: `vertex[i]` and `face[i]` are the new numbers
/// of the old i.
struct Shuffle {
  Shuffle(const OrganSurface& organ, std::mt19937& random);
  OrganSurface apply(const OrganSurface& organ) const;
  std::vector<float> apply(const std::vector<float>& vertices) const;

  std::vector<std::uint32_t> vertex, face;
};

}  // namespace organ_collision::bench
