#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// A closed surface: the sides of the cube [-1, 1]^3, each divided into cells of two faces, with
/// each point moved to `place(point)` [m]. Sides share their vertices. The face normals point
/// outward if `place` keeps the handedness.
template <typename Place>
TriangleMesh closed_mesh(int cells, const Place& place) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  std::map<std::tuple<int, int, int>, std::uint32_t> numbers;
  const auto vertex = [&](const Eigen::Vector3i& at) {
    const auto [entry, is_new] =
        numbers.insert({{at.x(), at.y(), at.z()}, static_cast<std::uint32_t>(numbers.size())});
    if (is_new) {
      const Eigen::Vector3d p = place((2.0 / cells) * at.cast<double>().array() - 1.0);
      for (const double x : p) vertices.push_back(static_cast<float>(x));
    }
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, cells}) {
      for (int u = 0; u < cells; ++u) {
        for (int v = 0; v < cells; ++v) {
          const auto corner = [&](int du, int dv) {
            Eigen::Vector3i at;
            at[axis] = side;
            at[(axis + 1) % 3] = u + du;
            at[(axis + 2) % 3] = v + dv;
            return vertex(at);
          };
          const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1),
                              d = corner(0, 1);
          if (side == 0) {
            triangles.insert(triangles.end(), {a, c, b, a, d, c});
          } else {
            triangles.insert(triangles.end(), {a, b, c, a, c, d});
          }
        }
      }
    }
  }
  return {vertices, triangles};
}

/// A block whose top is in the plane z = 0: 160 mm wide and 60 mm high.
inline TriangleMesh closed_block(int cells) {
  return closed_mesh(cells, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return {0.08 * p.x() + 0.0013, 0.08 * p.y() - 0.0007, 0.03 * p.z() - 0.03};
  });
}

/// An ellipsoid around the point (0, 0, -0.03), with the half axes 60, 50 and 30 mm.
inline TriangleMesh closed_ellipsoid(int cells) {
  return closed_mesh(cells, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const Eigen::Vector3d on_ball = p.normalized();
    return {0.06 * on_ball.x(), 0.05 * on_ball.y(), 0.03 * on_ball.z() - 0.03};
  });
}

}  // namespace organ_collision
