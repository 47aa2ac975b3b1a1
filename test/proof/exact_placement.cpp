#include "exact_placement.hpp"

#include <CGAL/Gmpzf.h>
#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "exact_distance.hpp"

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
N determinant(const Vector<N>& a, const Vector<N>& b, const Vector<N>& c) {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
         a.z * (b.x * c.y - b.y * c.x);
}

template <class N>
Vector<N> vector(const Eigen::Vector3d& v) {
  return {N(v.x()), N(v.y()), N(v.z())};
}

/// 1 if the axis crosses the face against its outward normal, -1 if along it, 0 if not. No sign may
/// be zero, unless the axis is parallel to the face.
template <class N, class Sign>
int direction(const Vector<N>& trocar, const Vector<N>& tip, const Triangle& face, Sign sign) {
  const Vector<N> a = vector<N>(face[0]), b = vector<N>(face[1]), c = vector<N>(face[2]);
  const int start = sign(determinant<N>(b - a, c - a, trocar - a));
  if (sign(determinant<N>(b - a, c - a, tip - a)) == start) return 0;
  const Vector<N> along = tip - trocar;
  const Vector<N> to_a = a - trocar, to_b = b - trocar, to_c = c - trocar;
  const int first = sign(determinant(along, to_a, to_b));
  if (sign(determinant(along, to_b, to_c)) != first) return 0;
  if (sign(determinant(along, to_c, to_a)) != first) return 0;
  return start;
}

/// By intervals, without the infinitesimal motion. Nothing if a sign is zero or not certain.
std::optional<int> certain_direction(const ShaftAxis& axis, const Triangle& face) {
  using N = CGAL::Interval_nt<false>;
  const auto certain_sign = [](const N& number) {
    if (number > N(0)) return 1;
    if (number < N(0)) return -1;
    throw CGAL::Uncertain_conversion_exception("the sign is zero");
  };
  const CGAL::Protect_FPU_rounding<true> protect;
  try {
    return direction(vector<N>(axis.trocar), vector<N>(axis.tip), face, certain_sign);
  } catch (const CGAL::Uncertain_conversion_exception&) {
    return std::nullopt;
  }
}

using Exact = CGAL::Gmpzf;

/// The point moved by (e, e^2, e^3) with e = 2^-1500. Every other nonzero number of a trial, and
/// every nonzero difference of their products, is far greater than e.
Vector<Exact> moved_infinitesimally(const Eigen::Vector3d& point) {
  static const Exact small = [] {
    const Exact half = std::ldexp(1.0, -750);
    return half * half;
  }();
  const Vector<Exact> p = vector<Exact>(point);
  return {p.x + small, p.y + small * small, p.z + small * small * small};
}

int exact_direction(const ShaftAxis& axis, const Triangle& face) {
  const std::optional<int> certain = certain_direction(axis, face);
  if (certain) return *certain;
  const auto exact_sign = [](const Exact& number) { return static_cast<int>(CGAL::sign(number)); };
  return direction(moved_infinitesimally(axis.trocar), moved_infinitesimally(axis.tip), face,
                   exact_sign);
}

/// Where the line through the axis meets the plane of a face that is not parallel to it.
double exact_place(const ShaftAxis& axis, const Triangle& face) {
  const Vector<Exact> a = vector<Exact>(face[0]);
  const Vector<Exact> u = vector<Exact>(face[1]) - a, v = vector<Exact>(face[2]) - a;
  const Vector<Exact> trocar = vector<Exact>(axis.trocar);
  const Exact above = determinant<Exact>(u, v, trocar - a);
  const Exact along = determinant<Exact>(u, v, vector<Exact>(axis.tip) - trocar);
  return -CGAL::to_double(above) / CGAL::to_double(along);
}

}  // namespace

std::vector<CrossedFace> crossed_faces(const ShaftAxis& axis, const std::vector<Triangle>& faces) {
  std::vector<CrossedFace> crossings;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const int direction = exact_direction(axis, faces[i]);
    if (direction != 0) crossings.push_back({i, direction, exact_place(axis, faces[i])});
  }
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const auto& a, const auto& b) { return a.place < b.place; });
  return crossings;
}

int winding_number(const Eigen::Vector3d& point, const Eigen::Vector3d& outside,
                   const std::vector<Triangle>& faces) {
  int winding = 0;
  for (const Triangle& face : faces) winding -= exact_direction({point, outside}, face);
  return winding;
}

bool lies_on(const Eigen::Vector3d& point, const std::vector<Triangle>& faces) {
  return std::any_of(faces.begin(), faces.end(), [&](const Triangle& face) {
    return within({point, point, point}, face, 0.0);
  });
}

}  // namespace organ_collision::oracle
