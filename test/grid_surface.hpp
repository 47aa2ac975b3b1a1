#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

struct GridSurface {
  std::vector<float> vertices;
  std::vector<FaceIndices> faces;

  std::vector<std::uint32_t> triangles() const {
    std::vector<std::uint32_t> flat;
    for (const FaceIndices& face : faces) flat.insert(flat.end(), face.begin(), face.end());
    return flat;
  }
};

/// A surface over a grid whose vertices are place(row, column) [m]. `closed`: the last column is
/// followed by the first. The faces point along the cross product of the directions of a row and a
/// column.
template <typename Place>
GridSurface grid_of(int rows, int columns, bool closed, const Place& place) {
  GridSurface grid;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Eigen::Vector3d at = place(row, column);
      for (const double value : at) grid.vertices.push_back(static_cast<float>(value));
    }
  }
  const auto vertex = [columns](int row, int column) {
    return static_cast<std::uint32_t>(row * columns + column % columns);
  };
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + (closed ? 0 : 1) < columns; ++column) {
      const std::uint32_t a = vertex(row, column), b = vertex(row, column + 1);
      const std::uint32_t c = vertex(row + 1, column + 1), d = vertex(row + 1, column);
      grid.faces.push_back({a, b, c});
      grid.faces.push_back({a, c, d});
    }
  }
  return grid;
}

/// A wavy sheet of 2 * side * side faces, 0.2 m wide, vertices row by row; `phase` deforms it.
inline GridSurface grid_surface(int side, double phase = 0.0) {
  return grid_of(side + 1, side + 1, false, [&](int row, int column) {
    const double x = 0.2 * column / side - 0.1, y = 0.2 * row / side - 0.1;
    const double z = 0.02 * std::sin(37.0 * x + phase) * std::cos(29.0 * y - 0.7 * phase);
    return Eigen::Vector3d(x, y, z);
  });
}

/// The same surface with its vertices and faces in random order.
inline GridSurface shuffled(const GridSurface& grid, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> place(grid.vertices.size() / 3);
  std::iota(place.begin(), place.end(), 0U);
  std::shuffle(place.begin(), place.end(), random);
  GridSurface result = grid;
  for (std::size_t i = 0; i < place.size(); ++i) {
    std::copy_n(&grid.vertices[3 * i], 3, &result.vertices[3 * place[i]]);
  }
  std::shuffle(result.faces.begin(), result.faces.end(), random);
  for (FaceIndices& face : result.faces) {
    for (std::uint32_t& vertex : face) vertex = place[vertex];
  }
  return result;
}

}  // namespace organ_collision
