#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "closest_points.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// A vertex of the Minkowski difference of face and core: the vector from a point of the core to a
/// corner of the face.
struct Vertex {
  Vector3d on_core;
  Vector3d separation;
  int corner;
};

/// The hull of up to four vertices, and its point that is nearest to the origin, as a weighted sum
/// of the vertices.
class Simplex {
 public:
  explicit Simplex(const Vertex& vertex)
      : vertices_{vertex}, nearest_{{0}, {1.0}, 1, vertex.separation} {}

  const Vector3d& nearest() const { return nearest_.point; }

  bool has(const Vertex& vertex) const {
    const auto is_same = [&](const Vertex& own) {
      return own.corner == vertex.corner && own.on_core == vertex.on_core;
    };
    return std::any_of(vertices_.begin(), vertices_.begin() + nearest_.count, is_same);
  }

  /// Adds a vertex and drops the vertices on which the nearest point no longer depends. If no point
  /// of the new hull is nearer to the origin, nothing changes and the result is false.
  bool add(const Vertex& vertex) {
    const int added = nearest_.count;
    vertices_[added] = vertex;
    Sum best = nearest_;
    consider({{added}, {1.0}, 1, vertex.separation}, best);
    for (int a = 0; a < added; ++a) {
      consider_edge(added, a, best);
      for (int b = a + 1; b < added; ++b) consider_triangle(added, a, b, best);
    }
    if (added == 3) consider_tetrahedron(best);
    if (!(best.point.squaredNorm() < nearest_.point.squaredNorm())) return false;
    keep(best);
    return true;
  }

  /// Whether the weighted sum of the vertices is nearest(). If a tetrahedron seems to contain the
  /// origin but is flat, its weights may be noise.
  bool is_exact() const {
    Vector3d point = Vector3d::Zero();
    for (int i = 0; i < nearest_.count; ++i) {
      point += nearest_.weights[i] * vertices_[i].separation;
    }
    return (point - nearest_.point).norm() <= tolerance::kTie;
  }

  ClosestPoints closest(const Triangle& face) const {
    ClosestPoints closest{nearest().norm(), 0.0, Vector3d::Zero(), Vector3d::Zero(), {}, nearest()};
    for (int i = 0; i < nearest_.count; ++i) {
      closest.on_core += nearest_.weights[i] * vertices_[i].on_core;
      closest.barycentric[vertices_[i].corner] += nearest_.weights[i];
    }
    closest.on_face = point_at(face, closest.barycentric);
    if (closest.distance == 0.0) closest.on_face = closest.on_core;
    return closest;
  }

 private:
  /// A weighted sum of the vertices with the given indices. The weights are not negative and sum to
  /// 1, so the sum is the vector from a point of the core to a point of the face. Rounding
  /// therefore never makes the distance too small.
  struct Sum {
    std::array<int, 4> indices;
    std::array<double, 4> weights;
    int count;
    Vector3d point;
  };

  static void consider(const Sum& sum, Sum& best) {
    if (sum.point.squaredNorm() < best.point.squaredNorm()) best = sum;
  }

  // Each of these functions finds the point nearest to the origin if that point lies inside the
  // edge, triangle or tetrahedron. A nearest point on its border is found by the other functions.

  void consider_edge(int i, int j, Sum& best) const {
    const Vector3d &a = vertices_[i].separation, edge = vertices_[j].separation - a;
    const double place = -a.dot(edge) / edge.squaredNorm();
    if (!(place > 0.0 && place < 1.0)) return;
    consider({{i, j}, {1.0 - place, place}, 2, a + place * edge}, best);
  }

  void consider_triangle(int i, int j, int k, Sum& best) const {
    const Vector3d &a = vertices_[i].separation, &b = vertices_[j].separation,
                   &c = vertices_[k].separation;
    const auto weights = project_origin(a, b, c, (b - a).cross(c - a));
    if (!weights) return;
    const Vector3d& w = *weights;
    consider({{i, j, k}, {w[0], w[1], w[2]}, 3, w[0] * a + w[1] * b + w[2] * c}, best);
  }

  void consider_tetrahedron(Sum& best) const {
    const Vector3d& a = vertices_[0].separation;
    const Vector3d b = vertices_[1].separation - a, c = vertices_[2].separation - a;
    const Vector3d d = vertices_[3].separation - a;
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

/// The vertex of the Minkowski difference that is farthest against `direction`: no vector from a
/// point of the core to a point of the face has a smaller dot product with `direction`.
Vertex support_against(const Vector3d& direction, const ConvexCore& core, const Triangle& face) {
  const Vector3d places(direction.dot(face[0]), direction.dot(face[1]), direction.dot(face[2]));
  int corner = 0;
  places.minCoeff(&corner);
  const Vector3d on_core = core.support(direction);
  return {on_core, face[corner] - on_core, corner};
}

/// The nearest points of two triangles: the nearest pair of an edge of one triangle and the other
/// triangle. This is slower than the iteration, but exact for slivers, too.
ClosestPoints nearest_of_edges(const Triangle& core, const Triangle& face) {
  ClosestPoints nearest{std::numeric_limits<double>::infinity(), 0.0, {}, {}, {}, {}};
  const auto consider = [&](const ClosestPoints& other) {
    if (other.distance < nearest.distance) nearest = other;
  };
  for (int from = 0; from < 3; ++from) {
    const int to = (from + 1) % 3;
    consider(axis_closest_points({core[from], core[to]}, face));
    ClosestPoints turned = axis_closest_points({face[from], face[to]}, core);
    std::swap(turned.on_core, turned.on_face);
    turned.separation = -turned.separation;
    turned.barycentric =
        (1.0 - turned.shaft) * Vector3d::Unit(from) + turned.shaft * Vector3d::Unit(to);
    consider(turned);
  }
  nearest.shaft = 0.0;
  nearest.steps *= 6;
  return nearest;
}

}  // namespace

ClosestPoints gjk_closest_points(const ConvexCore& hull, const Triangle& face,
                                 double distance_bound) {
  constexpr int kMaxSteps = 100;  // About five are needed.
  Simplex simplex(support_against(face[0] - hull.points[0], hull, face));
  int step = 1;
  for (; step < kMaxSteps; ++step) {
    const double distance = simplex.nearest().norm();
    if (distance <= tolerance::kTie) break;
    const Vertex next = support_against(simplex.nearest(), hull, face);
    const double least = simplex.nearest().dot(next.separation) / distance;
    if (least > distance_bound) {
      ClosestPoints closest = simplex.closest(face);
      closest.distance = least;
      closest.steps = step;
      return closest;
    }
    if (distance - least <= tolerance::kTie * std::max(1.0, distance)) break;
    if (simplex.has(next) || !simplex.add(next)) {
      // Rounding prevents progress, for example if a triangle is a sliver.
      if (!hull.is_triangle()) break;
      return nearest_of_edges(hull.triangle(), face);
    }
  }
  if (hull.is_triangle() && simplex.nearest().isZero(0.0) && !simplex.is_exact()) {
    return nearest_of_edges(hull.triangle(), face);
  }
  ClosestPoints closest = simplex.closest(face);
  closest.steps = step;
  return closest;
}

}  // namespace organ_collision
