#include "exact_distance.hpp"

#include <CGAL/Gmpzf.h>
#include <CGAL/Interval_nt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

// The closest points of two triangles are at two corners, at a corner and an edge, at two edges, at
// a corner of one and in the interior of the other, or where an edge of one pierces the other. Each
// of these cases gives the distance of two points of the triangles, so the smallest is the distance
// of the triangles. No number is ever divided or rounded.

namespace organ_collision::oracle {
namespace {

template <class Number>
struct Vector {
  Number x, y, z;
};

template <class N>
Vector<N> operator-(const Vector<N>& a, const Vector<N>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class N>
N dot(const Vector<N>& a, const Vector<N>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class N>
Vector<N> cross(const Vector<N>& a, const Vector<N>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class N>
N square(const Vector<N>& a) {
  return dot(a, a);
}

template <class N>
using Corners = std::array<Vector<N>, 3>;

template <class N>
Corners<N> corners(const Triangle& t) {
  const auto vector = [](const Eigen::Vector3d& v) { return Vector<N>{v.x(), v.y(), v.z()}; };
  return {vector(t[0]), vector(t[1]), vector(t[2])};
}

/// Calls `visit(numerator, denominator)` with the squared distance of each pair of features that
/// may contain the closest points, until it returns true.
template <class N, class Visit>
class Features {
 public:
  Features(const Corners<N>& a, const Corners<N>& b, Visit visit) : a_(a), b_(b), visit_(visit) {}

  bool any() {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (visit_(square<N>(a_[i] - b_[j]), N(1))) return true;
        if (corner_edge(a_[i], b_[j], b_[(j + 1) % 3])) return true;
        if (corner_edge(b_[i], a_[j], a_[(j + 1) % 3])) return true;
        if (edges(a_[i], a_[(i + 1) % 3], b_[j], b_[(j + 1) % 3])) return true;
      }
    }
    return inside(a_, b_) || inside(b_, a_);
  }

 private:
  bool corner_edge(const Vector<N>& corner, const Vector<N>& from, const Vector<N>& to) {
    const Vector<N> edge = to - from, arm = corner - from;
    const N along = dot(arm, edge), length2 = square(edge);
    if (length2 == N(0) || along < N(0) || along > length2) return false;
    return visit_(square(cross(arm, edge)), length2);
  }

  bool edges(const Vector<N>& p, const Vector<N>& p_to, const Vector<N>& q, const Vector<N>& q_to) {
    const Vector<N> u = p_to - p, v = q_to - q, across = cross(u, v), arm = q - p;
    const N across2 = square(across);
    if (across2 == N(0)) return false;
    const N on_p = dot(cross(arm, v), across), on_q = dot(cross(arm, u), across);
    if (on_p < N(0) || on_p > across2 || on_q < N(0) || on_q > across2) return false;
    const N height = dot(arm, across);
    return visit_(height * height, across2);
  }

  /// Visits the corners of `other` above the interior of `face`, and its edges that pierce it.
  bool inside(const Corners<N>& face, const Corners<N>& other) {
    const Vector<N> normal = cross(face[1] - face[0], face[2] - face[0]);
    const N normal2 = square(normal);
    if (normal2 == N(0)) return false;
    const N heights[] = {dot(normal, other[0] - face[0]), dot(normal, other[1] - face[0]),
                         dot(normal, other[2] - face[0])};
    for (int i = 0; i < 3; ++i) {
      if (beside_all_edges(face, other[i], normal)) {
        if (visit_(heights[i] * heights[i], normal2)) return true;
      }
      const int next = (i + 1) % 3;
      const bool crosses = (heights[i] < N(0) && heights[next] > N(0)) ||
                           (heights[i] > N(0) && heights[next] < N(0));
      if (crosses && beside_all_edges(face, other[i], other[next] - other[i])) {
        if (visit_(N(0), N(1))) return true;
      }
    }
    return false;
  }

  /// Whether the line through `point` along `direction` passes all edges on one side.
  bool beside_all_edges(const Corners<N>& face, const Vector<N>& point,
                        const Vector<N>& direction) {
    bool left = true, right = true;
    for (int i = 0; i < 3; ++i) {
      const N side = dot(direction, cross(face[i] - point, face[(i + 1) % 3] - point));
      if (side < N(0)) left = false;
      if (side > N(0)) right = false;
    }
    return left || right;
  }

  const Corners<N>& a_;
  const Corners<N>& b_;
  Visit visit_;
};

template <class N>
bool within_as(const Triangle& a, const Triangle& b, double radius) {
  const N radius2 = N(radius) * N(radius);
  const auto near = [&](const N& numerator, const N& denominator) -> bool {
    return numerator <= radius2 * denominator;
  };
  const Corners<N> first = corners<N>(a), second = corners<N>(b);
  return Features<N, decltype(near)>(first, second, near).any();
}

/// The same by interval arithmetic. Returns nothing if rounding could change the answer.
std::optional<bool> within_by_intervals(const Triangle& a, const Triangle& b, double radius) {
  const CGAL::Protect_FPU_rounding<true> protect;
  try {
    return within_as<CGAL::Interval_nt<false>>(a, b, radius);
  } catch (const CGAL::Uncertain_conversion_exception&) {
    return std::nullopt;
  }
}

}  // namespace

bool within(const Triangle& a, const Triangle& b, double radius) {
  const std::optional<bool> certain = within_by_intervals(a, b, radius);
  return certain ? *certain : within_as<CGAL::Gmpzf>(a, b, radius);
}

double distance(const Triangle& a, const Triangle& b) {
  using N = CGAL::Gmpzf;
  std::optional<std::pair<N, N>> least;
  const auto keep_least = [&](const N& numerator, const N& denominator) {
    if (!least || numerator * least->second < least->first * denominator)
      least = {numerator, denominator};
    return false;
  };
  const Corners<N> first = corners<N>(a), second = corners<N>(b);
  Features<N, decltype(keep_least)>(first, second, keep_least).any();
  return std::sqrt(CGAL::to_double(least->first) / CGAL::to_double(least->second));
}

namespace {

using Eigen::Vector3d;

double place_on(const Vector3d& point, const Vector3d& from, const Vector3d& along) {
  const double length2 = along.squaredNorm();
  return length2 > 0.0 ? std::clamp(along.dot(point - from) / length2, 0.0, 1.0) : 0.0;
}

double point_segment(const Vector3d& point, const Vector3d& from, const Vector3d& to) {
  const Vector3d along = to - from;
  return (from + place_on(point, from, along) * along - point).norm();
}

/// The nearest points of two segments in the interior of both. The ends have candidates of their
/// own.
double segments(const Vector3d& p, const Vector3d& p_to, const Vector3d& q, const Vector3d& q_to) {
  const Vector3d u = p_to - p, v = q_to - q;
  const Vector3d across = u.cross(v);
  const double across2 = across.squaredNorm();
  if (!(across2 > 0.0)) return INFINITY;
  const double on_p = std::clamp((q - p).cross(v).dot(across) / across2, 0.0, 1.0);
  const Vector3d on_u = p + on_p * u;
  const Vector3d on_v = q + place_on(on_u, q, v) * v;
  return point_segment(on_v, p, p_to);
}

/// The barycentric coordinates of the point's foot on the face's plane, if it is in the face.
std::optional<Vector3d> foot(const Vector3d& point, const Triangle& face) {
  const Vector3d normal = (face[1] - face[0]).cross(face[2] - face[0]);
  const double normal2 = normal.squaredNorm();
  if (!(normal2 > 0.0)) return std::nullopt;
  Vector3d weights;
  for (int i = 0; i < 3; ++i) {
    const Vector3d from = face[(i + 1) % 3] - point, to = face[(i + 2) % 3] - point;
    weights[i] = from.cross(to).dot(normal) / normal2;
  }
  if (weights.minCoeff() < 0.0) return std::nullopt;
  return weights / weights.sum();
}

double point_face(const Vector3d& point, const Triangle& face) {
  const std::optional<Vector3d> at = foot(point, face);
  if (!at) return INFINITY;
  return ((*at)[0] * face[0] + (*at)[1] * face[1] + (*at)[2] * face[2] - point).norm();
}

/// How far the point in which the edge pierces the plane is from the face, if it does.
double edge_face(const Vector3d& from, const Vector3d& to, const Triangle& face) {
  const Vector3d normal = (face[1] - face[0]).cross(face[2] - face[0]);
  const double below = normal.dot(from - face[0]), above = normal.dot(to - face[0]);
  if (below * above >= 0.0) return INFINITY;
  return point_face(from + below / (below - above) * (to - from), face);
}

}  // namespace

double rounded_distance(const Triangle& a, const Triangle& b) {
  double least = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const Vector3d &from = a[i], &to = a[(i + 1) % 3];
    least = std::min({least, point_face(from, b), point_face(b[i], a), edge_face(from, to, b),
                      edge_face(b[i], b[(i + 1) % 3], a)});
    for (int j = 0; j < 3; ++j) {
      const Vector3d &other_from = b[j], &other_to = b[(j + 1) % 3];
      least =
          std::min({least, point_segment(from, other_from, other_to),
                    point_segment(other_from, from, to), segments(from, to, other_from, other_to)});
    }
  }
  return least;
}

namespace {

/// The minimum of a convex function on [0, 1], by golden section search (Kiefer 1953): the interval
/// shrinks by 0.618 in each of `rounds` rounds.
template <typename Function>
double least_value(int rounds, const Function& function) {
  constexpr double kGolden = 0.61803398874989484820;
  double low = 0.0, high = 1.0;
  double a = high - kGolden, b = low + kGolden;
  double at_a = function(a), at_b = function(b);
  double least = std::min({function(0.0), function(1.0), at_a, at_b});
  for (int i = 0; i < rounds; ++i) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - kGolden * (high - low);
      least = std::min(least, at_a = function(a));
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + kGolden * (high - low);
      least = std::min(least, at_b = function(b));
    }
  }
  return least;
}

double distance_of_cylinder(const ConvexCore& core, const Vector3d& point) {
  const Vector3d axis = core.points[1] - core.points[0];
  const Vector3d from_middle = point - 0.5 * (core.points[0] + core.points[1]);
  const double along = from_middle.dot(axis.normalized());
  const double beside = (from_middle - along * axis.normalized()).norm();
  return std::hypot(std::max(0.0, std::abs(along) - 0.5 * axis.norm()),
                    std::max(0.0, beside - core.rim.col(0).norm()));
}

/// The sides of a box, by its corners in the order of LinkPart::box: z changes first, x last.
constexpr std::array<std::array<int, 4>, 6> kSides = {
    {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};

bool box_contains(const ConvexCore& core, const Vector3d& point) {
  for (const int corner : {1, 2, 4}) {
    const Vector3d edge = core.points[corner] - core.points[0];
    const double along = edge.dot(point - core.points[0]);
    if (along < 0.0 || along > edge.squaredNorm()) return false;
  }
  return true;
}

/// The inner minimum is a convex function of u, because `across` is linear in u.
double distance_of_cylinder(const ConvexCore& core, const Triangle& face, int rounds) {
  return least_value(rounds, [&](double u) {
    const Vector3d from = face[0] + u * (face[1] - face[0]);
    const Vector3d across = (1.0 - u) * (face[2] - face[0]);
    return least_value(rounds,
                       [&](double v) { return distance_of_cylinder(core, from + v * across); });
  });
}

/// The two triangles of each side of a box.
std::vector<Triangle> sides_of_box(const ConvexCore& core) {
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c, d] : kSides) {
    const auto& p = core.points;
    triangles.push_back({p[a], p[b], p[c]});
    triangles.push_back({p[a], p[c], p[d]});
  }
  return triangles;
}

/// A core of at most three points as a triangle, which may be degenerate.
Triangle triangle_of(const ConvexCore& core) {
  const auto& p = core.points;
  return {p[0], p[core.count > 1 ? 1 : 0], p[core.count > 2 ? 2 : core.count - 1]};
}

}  // namespace

double distance(const ConvexCore& core, const Triangle& face) {
  if (core.is_cylinder()) return distance_of_cylinder(core, face, 60);
  if (core.count != 8) return distance(triangle_of(core), face);
  if (box_contains(core, face[0])) return 0.0;
  double least = INFINITY;
  for (const Triangle& side : sides_of_box(core)) least = std::min(least, distance(side, face));
  return least;
}

bool within(const ConvexCore& core, const Triangle& face, double radius) {
  if (core.is_cylinder()) return distance(core, face) <= radius;
  if (core.count != 8) return within(triangle_of(core), face, radius);
  const std::vector<Triangle> sides = sides_of_box(core);
  return box_contains(core, face[0]) ||
         std::any_of(sides.begin(), sides.end(),
                     [&](const Triangle& side) { return within(side, face, radius); });
}

double rounded_distance(const ConvexCore& core, const Triangle& face) {
  if (core.is_cylinder()) return distance_of_cylinder(core, face, 40);
  if (core.count != 8) return rounded_distance(triangle_of(core), face);
  if (box_contains(core, face[0])) return 0.0;
  double least = INFINITY;
  for (const Triangle& side : sides_of_box(core)) {
    least = std::min(least, rounded_distance(side, face));
  }
  return least;
}

double distance(const ConvexCore& core, const Vector3d& point) {
  if (core.is_cylinder()) return distance_of_cylinder(core, point);
  return distance(core, Triangle{point, point, point});
}

}  // namespace organ_collision::oracle
