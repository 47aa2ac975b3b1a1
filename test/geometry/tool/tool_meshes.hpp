#pragma once

#include <cstdint>
#include <vector>

#include "organ_collision/geometry/tool/tool_surface.hpp"
#include "test/grid_surface.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {

/// The input of a ToolSurface.
struct ToolMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<FaceIndices> faces;

  ToolSurface surface() const { return {vertices, faces}; }
};

/// Scattered faces of all sizes. Some are segments or points, some are repeated.
inline ToolMesh scattered_mesh(std::size_t faces, oracle::Random& random) {
  ToolMesh mesh;
  for (std::uint32_t i = 0; i < faces; ++i) {
    const Eigen::Vector3d center = random.point(0.05);
    const double size = random.scale(1e-5, 0.05);
    for (int corner = 0; corner < 3; ++corner) {
      mesh.vertices.emplace_back(center + size * random.direction());
    }
    FaceIndices face = {3 * i, 3 * i + 1, 3 * i + 2};
    if (random.chance(0.1)) face[1] = face[0];
    if (random.chance(0.05)) face = {3 * i, 3 * i, 3 * i};
    if (i > 0 && random.chance(0.1)) face = mesh.faces.back();
    mesh.faces.push_back(face);
  }
  return mesh;
}

/// A wavy sheet of 2 * side * side faces, 0.2 m wide times `scale`.
inline ToolMesh wavy_mesh(int side, double scale) {
  const GridSurface grid = grid_surface(side);
  ToolMesh mesh;
  for (std::size_t i = 0; i < grid.vertices.size(); i += 3) {
    mesh.vertices.emplace_back(
        scale * Eigen::Vector3d(grid.vertices[i], grid.vertices[i + 1], grid.vertices[i + 2]));
  }
  mesh.faces = grid.faces;
  return mesh;
}

}  // namespace organ_collision
