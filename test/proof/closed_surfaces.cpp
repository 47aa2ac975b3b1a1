#include "closed_surfaces.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;
using Index = std::uint32_t;

ClosedSurface tetrahedron(Random& random) {
  return {{random.point(1.0), random.point(1.0), random.point(1.0), random.point(1.0)},
          {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

/// Sizes and places are multiples of 1/16, so that edges and faces line up with axes exactly.
ClosedSurface lattice_box(Random& random) {
  const auto steps = [&](int low, int high) {
    return Vector3d(random.integer(low, high), random.integer(low, high),
                    random.integer(low, high));
  };
  const Vector3d origin = steps(-16, 0) / 16.0, size = steps(1, 16) / 16.0;
  ClosedSurface box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.emplace_back(origin + size.cwiseProduct(Vector3d(i & 1, i >> 1 & 1, i >> 2)));
  }
  box.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
               {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return box;
}

/// An octahedron, with each face cut into four if `fine`.
ClosedSurface ball(bool fine) {
  ClosedSurface surface{
      {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ(), -Vector3d::UnitX(),
       -Vector3d::UnitY(), -Vector3d::UnitZ()},
      {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}}};
  if (!fine) return surface;
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [place, is_new] = middles.emplace(std::minmax(a, b), surface.vertices.size());
    if (is_new) {
      surface.vertices.push_back((surface.vertices[a] + surface.vertices[b]).normalized());
    }
    return place->second;
  };
  const auto coarse = std::exchange(surface.faces, {});
  for (const auto& [a, b, c] : coarse) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const std::array<Index, 3>& face :
         {std::array<Index, 3>{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
      surface.faces.push_back(face);
    }
  }
  return surface;
}

void dent(ClosedSurface& surface, Random& random) {
  for (Vector3d& vertex : surface.vertices) vertex *= random.uniform(0.3, 1.0);
}

ClosedSurface torus() {
  constexpr Index kAround = 5, kAcross = 4;
  ClosedSurface surface;
  for (Index i = 0; i < kAround; ++i) {
    for (Index j = 0; j < kAcross; ++j) {
      const double u = 2.0 * M_PI * i / kAround, v = 2.0 * M_PI * j / kAcross;
      const double reach = 0.7 + 0.3 * std::cos(v);
      surface.vertices.emplace_back(reach * std::cos(u), reach * std::sin(u), 0.3 * std::sin(v));
      const auto at = [](Index a, Index b) { return a % kAround * kAcross + b % kAcross; };
      const Index here = at(i, j), right = at(i + 1, j), above = at(i, j + 1);
      const Index across = at(i + 1, j + 1);
      surface.faces.push_back({here, right, across});
      surface.faces.push_back({here, across, above});
    }
  }
  return surface;
}

ClosedSurface moved(ClosedSurface surface, double scale, const Vector3d& shift) {
  for (Vector3d& vertex : surface.vertices) vertex = scale * vertex + shift;
  return surface;
}

ClosedSurface inside_out(ClosedSurface surface) {
  for (auto& face : surface.faces) std::swap(face[1], face[2]);
  return surface;
}

ClosedSurface joined(ClosedSurface first, const ClosedSurface& second) {
  const auto offset = static_cast<Index>(first.vertices.size());
  first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
  for (const auto& [a, b, c] : second.faces) {
    first.faces.push_back({a + offset, b + offset, c + offset});
  }
  return first;
}

ClosedSurface with_cavity(Random& random) {
  return joined(ball(random.chance(0.5)), inside_out(moved(ball(false), 0.3, random.point(0.1))));
}

/// The second body has a corner at a corner of the first one.
ClosedSurface touching(Random& random) {
  ClosedSurface second = lattice_box(random), first = lattice_box(random);
  const Vector3d corner = first.vertices[random.integer(0, 7)];
  return joined(first, moved(second, 1.0, corner - second.vertices[random.integer(0, 7)]));
}

ClosedSurface overlapping(Random& random) {
  return joined(ball(random.chance(0.5)), moved(ball(false), 0.8, random.point(0.5)));
}

/// Some vertices lie where a neighbour lies.
ClosedSurface collapsed(Random& random) {
  ClosedSurface surface = ball(true);
  dent(surface, random);
  for (int i = 0; i < 3; ++i) {
    const auto& face = surface.faces[random.integer(0, 31)];
    surface.vertices[face[0]] = surface.vertices[face[1]];
  }
  return surface;
}

ClosedSurface any_surface(Random& random) {
  switch (random.integer(0, 7)) {
    case 0:
      return tetrahedron(random);
    case 1:
      return lattice_box(random);
    case 2: {
      ClosedSurface surface = ball(random.chance(0.5));
      dent(surface, random);
      return surface;
    }
    case 3:
      return torus();
    case 4:
      return with_cavity(random);
    case 5:
      return touching(random);
    case 6:
      return overlapping(random);
    default:
      return collapsed(random);
  }
}

}  // namespace

ClosedSurface make_closed_surface(Random& random) {
  ClosedSurface surface = any_surface(random);
  if (random.chance(0.2)) surface = inside_out(surface);
  if (random.chance(0.5)) {  // else it stays on its lattice
    surface = moved(surface, random.scale(1e-3, 1.0), random.point(0.2));
    if (random.chance(0.1)) surface = moved(surface, 1.0, 1e3 * random.direction());
  }
  for (Vector3d& vertex : surface.vertices) vertex = rounded(vertex);
  return surface;
}

ClosedSurface without_shared_vertices(const ClosedSurface& surface) {
  ClosedSurface soup;
  for (const auto& face : surface.faces) {
    const auto first = static_cast<Index>(soup.vertices.size());
    for (const Index corner : face) soup.vertices.push_back(surface.vertices[corner]);
    soup.faces.push_back({first, first + 1, first + 2});
  }
  return soup;
}

}  // namespace organ_collision::oracle
