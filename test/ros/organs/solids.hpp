#pragma once

#include <cstdint>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

inline const std::vector<std::uint32_t> kOutward{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
inline const std::vector<std::uint32_t> kInward{0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};

/// Corners of a tetrahedron with sides of 3, 4 and 5 cm, at (1, 2, 3) dm, times `unit`.
inline std::vector<float> corners(float unit = 1.0F) {
  std::vector<float> corners{0.1F, 0.2F,  0.3F, 0.13F, 0.2F, 0.3F,
                             0.1F, 0.24F, 0.3F, 0.1F,  0.2F, 0.35F};
  for (float& coordinate : corners) coordinate *= unit;
  return corners;
}

/// That tetrahedron. It is closed and points outward, unless other triangles are given.
inline TriangleMesh tetrahedron(const std::vector<std::uint32_t>& triangles = kOutward,
                                float unit = 1.0F, std::uint32_t topology = 1) {
  return {corners(unit), triangles, topology};
}

}  // namespace organ_collision
