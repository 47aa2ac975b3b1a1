#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "test/grid_surface.hpp"

namespace organ_collision {

inline void add_vertex(GridSurface& surface, const std::array<float, 3>& at) {
  for (const float coordinate : at) surface.vertices.push_back(coordinate);
}

/// A closed, wavy torus: a grid whose opposite sides are joined. It points outward.
inline GridSurface torus(int around, int along, double radius, double phase) {
  GridSurface solid;
  for (int i = 0; i < along; ++i) {
    for (int k = 0; k < around; ++k) {
      const double u = 2 * M_PI * i / along, v = 2 * M_PI * k / around;
      const double thickness = radius * (0.3 + 0.05 * std::sin(3 * u + phase));
      const double r = radius + thickness * std::cos(v);
      add_vertex(solid, {static_cast<float>(r * std::cos(u)), static_cast<float>(r * std::sin(u)),
                         static_cast<float>(thickness * std::sin(v))});
    }
  }
  const auto at = [=](int i, int k) {
    return static_cast<std::uint32_t>(i % along * around + k % around);
  };
  for (int i = 0; i < along; ++i) {
    for (int k = 0; k < around; ++k) {
      solid.faces.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      solid.faces.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return solid;
}

/// A sphere of triangles around the origin. Its corners are on the sphere. It points outward.
inline GridSurface sphere(int rings, int sectors, double radius) {
  GridSurface solid;
  const auto add = [&](double polar, double around) {
    add_vertex(solid, {static_cast<float>(radius * std::sin(polar) * std::cos(around)),
                       static_cast<float>(radius * std::sin(polar) * std::sin(around)),
                       static_cast<float>(radius * std::cos(polar))});
  };
  add(0.0, 0.0);
  for (int ring = 1; ring <= rings; ++ring) {
    for (int k = 0; k < sectors; ++k) add(M_PI * ring / (rings + 1), 2 * M_PI * k / sectors);
  }
  add(M_PI, 0.0);
  const auto at = [=](int ring, int k) {
    return static_cast<std::uint32_t>(1 + ring * sectors + k % sectors);
  };
  const auto last = static_cast<std::uint32_t>(1 + rings * sectors);
  for (int k = 0; k < sectors; ++k) {
    solid.faces.push_back({0, at(0, k), at(0, k + 1)});
    for (int ring = 0; ring + 1 < rings; ++ring) {
      solid.faces.push_back({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)});
      solid.faces.push_back({at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
    }
    solid.faces.push_back({at(rings - 1, k), last, at(rings - 1, k + 1)});
  }
  return solid;
}

/// A cube from 0 to side * spacing whose faces have all their corners on a grid. It points outward.
/// Each vertex belongs to one of the six squares only, so there are seams.
inline GridSurface grid_cube(int side, float spacing) {
  GridSurface solid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool far : {false, true}) {
      const auto first = static_cast<std::uint32_t>(solid.vertices.size() / 3);
      for (int i = 0; i <= side; ++i) {
        for (int k = 0; k <= side; ++k) {
          std::array<float, 3> at;
          at[axis] = far ? spacing * static_cast<float>(side) : 0.0F;
          at[(axis + 1) % 3] = spacing * static_cast<float>(i);
          at[(axis + 2) % 3] = spacing * static_cast<float>(k);
          add_vertex(solid, at);
        }
      }
      const auto vertex = [=](int i, int k) {
        return first + static_cast<std::uint32_t>(i * (side + 1) + k);
      };
      for (int i = 0; i < side; ++i) {
        for (int k = 0; k < side; ++k) {
          FaceIndices one = {vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1)};
          FaceIndices other = {vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1)};
          for (FaceIndices* const face : {&one, &other}) {
            if (!far) std::swap((*face)[1], (*face)[2]);
            solid.faces.push_back(*face);
          }
        }
      }
    }
  }
  return solid;
}

inline GridSurface turned_over(GridSurface surface) {
  for (FaceIndices& face : surface.faces) std::swap(face[0], face[2]);
  return surface;
}

inline GridSurface moved(GridSurface surface, const std::array<float, 3>& by) {
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) surface.vertices[i] += by[i % 3];
  return surface;
}

inline GridSurface joined(const GridSurface& one, const GridSurface& other) {
  GridSurface both = one;
  const auto first = static_cast<std::uint32_t>(one.vertices.size() / 3);
  both.vertices.insert(both.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const FaceIndices& face : other.faces) {
    both.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
  }
  return both;
}

/// The same surface, with three vertices of its own for each face, as in an STL file.
inline GridSurface unwelded(const GridSurface& surface) {
  GridSurface soup;
  for (const FaceIndices& face : surface.faces) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size() / 3);
    for (const std::uint32_t corner : face) {
      const float* const at = &surface.vertices[3 * corner];
      add_vertex(soup, {at[0], at[1], at[2]});
    }
    soup.faces.push_back({first, first + 1, first + 2});
  }
  return soup;
}

}  // namespace organ_collision
