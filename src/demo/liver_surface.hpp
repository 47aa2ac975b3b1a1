#pragma once

#include <Eigen/Core>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// A closed surface whose faces are oriented outwards. Positions in metres.
struct ClosedSurface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<FaceIndices> faces;

  Triangle triangle(std::size_t face) const {
    const FaceIndices& f = faces[face];
    return {vertices[f[0]], vertices[f[1]], vertices[f[2]]};
  }
};

/// [m] Approximate signed distance to the surface of the liver, negative inside.
/// x points to the patient's left, y to the head, z to the front. The right lobe is the larger one.
double liver_level(const Eigen::Vector3d& point);

/// The liver's surface at rest: 614 vertices, 1224 faces, 0.2 m from lobe to lobe. It begins as the
/// surface of a box of 19 x 10 x 4 cells, with 2 triangles for each square. The vertices are moved
/// onto liver_level = 0 and spread evenly there.
ClosedSurface make_liver_surface();

}  // namespace organ_collision
