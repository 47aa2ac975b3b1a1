#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "closest_points.hpp"
#include "cylinder_distance.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// A point of the core, a corner of the face, and the way from the one to the other.
struct Vertex {
  Vector3d on_core;
  Vector3d apart;
  int corner;
};

/// The hull of up to four vertices, and its point nearest to the origin as a weighted sum of them.
class Simplex {
 public:
  explicit Simplex(const Vertex& vertex)
      : vertices_{vertex}, nearest_{{0}, {1.0}, 1, vertex.apart} {}

  const Vector3d& nearest() const { return nearest_.point; }

  bool has(const Vertex& vertex) const {
    const auto is_same = [&](const Vertex& own) {
      return own.corner == vertex.corner && own.on_core == vertex.on_core;
    };
    return std::any_of(vertices_.begin(), vertices_.begin() + nearest_.count, is_same);
  }

  /// Adds a vertex, and drops those that the nearest point no longer needs. False, and nothing
  /// changes, where that brings it no nearer.
  bool add(const Vertex& vertex) {
    const int added = nearest_.count;
    vertices_[added] = vertex;
    Sum best = nearest_;
    consider({{added}, {1.0}, 1, vertex.apart}, best);
    for (int a = 0; a < added; ++a) {
      consider_edge(added, a, best);
      for (int b = a + 1; b < added; ++b) consider_triangle(added, a, b, best);
    }
    if (added == 3) consider_tetrahedron(best);
    if (!(best.point.squaredNorm() < nearest_.point.squaredNorm())) return false;
    keep(best);
    return true;
  }

  ClosestPoints closest(const Triangle& face) const {
    ClosestPoints closest{nearest().norm(), 0.0, Vector3d::Zero(), Vector3d::Zero(), {}, nearest()};
    for (int i = 0; i < nearest_.count; ++i) {
      closest.on_core += nearest_.weights[i] * vertices_[i].on_core;
      closest.barycentric[vertices_[i].corner] += nearest_.weights[i];
    }
    closest.on_face = closest.barycentric[0] * face[0] + closest.barycentric[1] * face[1] +
                      closest.barycentric[2] * face[2];
    if (closest.distance == 0.0) closest.on_face = closest.on_core;
    return closest;
  }

 private:
  /// Of the vertices with these indices. Weights are not negative and sum up to 1, so that every
  /// sum is a way between real points: rounding never makes it too short.
  struct Sum {
    std::array<int, 4> indices;
    std::array<double, 4> weights;
    int count;
    Vector3d point;
  };

  static void consider(const Sum& sum, Sum& best) {
    if (sum.point.squaredNorm() < best.point.squaredNorm()) best = sum;
  }

  // Each considers the point nearest to the origin where that is inside; else it is on the border.

  void consider_edge(int i, int j, Sum& best) const {
    const Vector3d &a = vertices_[i].apart, edge = vertices_[j].apart - a;
    const double place = -a.dot(edge) / edge.squaredNorm();
    if (!(place > 0.0 && place < 1.0)) return;
    consider({{i, j}, {1.0 - place, place}, 2, a + place * edge}, best);
  }

  void consider_triangle(int i, int j, int k, Sum& best) const {
    const Vector3d &a = vertices_[i].apart, &b = vertices_[j].apart, &c = vertices_[k].apart;
    const Vector3d normal = (b - a).cross(c - a);
    const Vector3d areas(normal.dot(b.cross(c)), normal.dot(c.cross(a)), normal.dot(a.cross(b)));
    if (!(areas.minCoeff() >= 0.0) || !(areas.sum() > 0.0)) return;
    const Vector3d w = areas / areas.sum();
    consider({{i, j, k}, {w[0], w[1], w[2]}, 3, w[0] * a + w[1] * b + w[2] * c}, best);
  }

  void consider_tetrahedron(Sum& best) const {
    const Vector3d& a = vertices_[0].apart;
    const Vector3d b = vertices_[1].apart - a, c = vertices_[2].apart - a;
    const Vector3d d = vertices_[3].apart - a;
    const double volume = b.dot(c.cross(d));
    const Vector3d w =
        Vector3d(-a.dot(c.cross(d)), -b.dot(a.cross(d)), -b.dot(c.cross(a))) / volume;
    if (!(w.minCoeff() >= 0.0 && w.sum() <= 1.0)) return;
    best = {{0, 1, 2, 3}, {1.0 - w.sum(), w[0], w[1], w[2]}, 4, Vector3d::Zero()};
  }

  void keep(const Sum& best) {
    const std::array<Vertex, 4> all = vertices_;
    nearest_ = best;
    for (int i = 0; i < best.count; ++i) {
      vertices_[i] = all[best.indices[i]];
      nearest_.indices[i] = i;
    }
  }

  std::array<Vertex, 4> vertices_;
  Sum nearest_;
};

/// The pair farthest against `direction`: of the ways from core to face, none ends before it.
Vertex farthest_against(const Vector3d& direction, const ConvexCore& core, const Triangle& face) {
  const Vector3d heights(direction.dot(face[0]), direction.dot(face[1]), direction.dot(face[2]));
  int corner = 0;
  heights.minCoeff(&corner);
  const Vector3d on_core = core.support(direction);
  return {on_core, face[corner] - on_core, corner};
}

/// Of two triangles: some edge of the one is nearest to the other.
ClosestPoints nearest_of_edges(const Triangle& core, const Triangle& face) {
  ClosestPoints nearest = closest_points(ShaftAxis{core[0], core[1]}, face);
  const auto consider = [&](const ClosestPoints& other) {
    if (other.distance < nearest.distance) nearest = other;
  };
  for (int from = 0; from < 3; ++from) {
    const int to = (from + 1) % 3;
    consider(closest_points(ShaftAxis{core[from], core[to]}, face));
    ClosestPoints turned = closest_points(ShaftAxis{face[from], face[to]}, core);
    std::swap(turned.on_core, turned.on_face);
    turned.apart = -turned.apart;
    turned.barycentric =
        (1.0 - turned.shaft) * Vector3d::Unit(from) + turned.shaft * Vector3d::Unit(to);
    consider(turned);
  }
  nearest.shaft = 0.0;
  nearest.steps *= 6;
  return nearest;
}

}  // namespace

ClosestPoints closest_points(const ConvexCore& core, const Triangle& face, double enough) {
  if (core.is_axis()) return closest_points(core.axis(), face);
  if (core.is_cylinder()) return cylinder_closest_points(core, face);
  constexpr int kMaxSteps = 100;  // Some five suffice.
  Simplex simplex(farthest_against(face[0] - core.points[0], core, face));
  int step = 1;
  for (; step < kMaxSteps; ++step) {
    const double distance = simplex.nearest().norm();
    if (distance <= tolerance::kTie) break;
    const Vertex next = farthest_against(simplex.nearest(), core, face);
    const double least = simplex.nearest().dot(next.apart) / distance;
    if (least > enough) {
      ClosestPoints closest = simplex.closest(face);
      closest.distance = least;
      closest.steps = step;
      return closest;
    }
    if (distance - least <= tolerance::kTie * std::max(1.0, distance)) break;
    if (simplex.has(next) || !simplex.add(next)) {
      // Slivers: what is left of the simplex is rounding.
      if (core.count > 3) break;
      return nearest_of_edges({core.points[0], core.points[1], core.points[2]}, face);
    }
  }
  ClosestPoints closest = simplex.closest(face);
  closest.steps = step;
  return closest;
}

}  // namespace organ_collision
