#include "exact_distance.hpp"

#include <CGAL/Gmpzf.h>
#include <CGAL/Interval_nt.h>

#include <cmath>
#include <optional>
#include <utility>

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

}  // namespace organ_collision::oracle
