#include "exact_sides.hpp"

#include <CGAL/Gmpq.h>
#include <CGAL/Gmpzf.h>
#include <CGAL/Interval_nt.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace organ_collision::oracle {
namespace {

using Number = CGAL::Gmpzf;
using Vector = std::array<Number, 3>;

Vector exact(const Eigen::Vector3d& v) { return {Number(v.x()), Number(v.y()), Number(v.z())}; }
Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Number dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector moved(const Eigen::Vector3d& point) {
  const Number thousandth(std::ldexp(1.0, -1000));
  const Number h = thousandth * thousandth * thousandth * thousandth;
  return exact(point) + Vector{h, h * h, h * h * h};
}

/// Where a line from `start` along `along` meets a plane: place / divisor, with the barycentric
/// coordinates part / divisor. The divisor is positive, or 0 if they are parallel.
struct Meeting {
  Meeting(const Vector& start, const Vector& along, const Triangle& face) {
    const Vector corner = exact(face[0]);
    const Vector u = exact(face[1]) - corner, v = exact(face[2]) - corner;
    const Vector p = cross(along, v), from_corner = start - corner, q = cross(from_corner, u);
    divisor = dot(u, p);
    direction = CGAL::sign(divisor);
    const Number turn(static_cast<int>(direction));
    divisor = turn * divisor;
    place = turn * dot(v, q);
    parts[1] = turn * dot(from_corner, p);
    parts[2] = turn * dot(along, q);
    parts[0] = divisor - parts[1] - parts[2];
  }

  bool is_in_face() const {
    if (direction == 0) return false;
    for (const Number& part : parts) {
      if (CGAL::sign(part) < 0) return false;
    }
    return true;
  }
  bool is_on_edge() const {
    return is_in_face() &&
           (CGAL::sign(parts[0]) == 0 || CGAL::sign(parts[1]) == 0 || CGAL::sign(parts[2]) == 0);
  }

  Number divisor, place;
  std::array<Number, 3> parts;
  int direction;
};

double quotient(const Number& above, const Number& below) {
  return CGAL::to_double(above) / CGAL::to_double(below);
}

bool boxes_meet(const Triangle& face, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  for (int i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax({face[0][i], face[1][i], face[2][i]});
    if (std::max(from[i], to[i]) < low || std::min(from[i], to[i]) > high) return false;
  }
  return true;
}

}  // namespace

std::vector<ExactCrossing> exact_crossings(const std::vector<Triangle>& faces,
                                           const ShaftAxis& axis) {
  const Vector trocar = moved(axis.trocar), along = moved(axis.tip) - trocar;
  struct Found {
    std::uint32_t face;
    Meeting meeting;
  };
  std::vector<Found> found;
  for (std::uint32_t i = 0; i < faces.size(); ++i) {
    if (!boxes_meet(faces[i], axis.trocar, axis.tip)) continue;
    const Meeting meeting(trocar, along, faces[i]);
    if (!meeting.is_in_face()) continue;
    if (CGAL::sign(meeting.place) < 0 || meeting.divisor < meeting.place) continue;
    if (meeting.is_on_edge() || CGAL::sign(meeting.place) == 0 ||
        meeting.place == meeting.divisor) {
      throw std::logic_error("the moved axis is not in general position");
    }
    found.push_back({i, meeting});
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    const Number left = a.meeting.place * b.meeting.divisor;
    const Number right = b.meeting.place * a.meeting.divisor;
    return left < right || (left == right && a.meeting.direction < b.meeting.direction);
  });
  std::vector<ExactCrossing> crossings;
  for (const auto& [face, m] : found) {
    crossings.push_back({face,
                         m.direction,
                         quotient(m.place, m.divisor),
                         {quotient(m.parts[0], m.divisor), quotient(m.parts[1], m.divisor),
                          quotient(m.parts[2], m.divisor)}});
  }
  return crossings;
}

int exact_winding(const std::vector<Triangle>& faces, const Eigen::Vector3d& point) {
  const Vector start = moved(point);
  const Vector ray = exact(Eigen::Vector3d(0.318281828, -0.271828459, 0.577215664));
  const Eigen::Vector3d end = point + 1e7 * Eigen::Vector3d(1.0, -1.0, 1.0);  // behind all faces
  int winding = 0;
  for (const Triangle& face : faces) {
    if (!boxes_meet(face, point, end)) continue;
    const Meeting meeting(start, ray, face);
    if (!meeting.is_in_face() || CGAL::sign(meeting.place) < 0) continue;
    if (meeting.is_on_edge()) throw std::logic_error("the ray meets an edge");
    winding -= meeting.direction;
  }
  return winding;
}

bool is_exactly_on(const Triangle& face, const Eigen::Vector3d& point) {
  const Vector p = exact(point);
  const std::array<Vector, 3> corners = {exact(face[0]), exact(face[1]), exact(face[2])};
  const Vector normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  if (CGAL::sign(dot(normal, p - corners[0])) != 0) return false;
  bool is_degenerate = true;
  for (const Number& n : normal) is_degenerate = is_degenerate && CGAL::sign(n) == 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector edge = corners[(i + 1) % 3] - corners[i], to_point = p - corners[i];
    if (!is_degenerate) {
      if (CGAL::sign(dot(normal, cross(edge, to_point))) < 0) return false;
      continue;
    }
    const Vector off = cross(edge, to_point);
    const Number along = dot(edge, to_point);
    const bool is_on_line = CGAL::sign(dot(off, off)) == 0;
    if (is_on_line && CGAL::sign(along) >= 0 && !(dot(edge, edge) < along)) {
      if (CGAL::sign(dot(edge, edge)) != 0 || CGAL::sign(dot(to_point, to_point)) == 0) return true;
    }
  }
  return !is_degenerate;
}

int exact_triple_sign(const std::array<Eigen::Vector3d, 6>& points) {
  std::array<Vector, 3> rows;
  for (std::size_t i = 0; i < 3; ++i) rows[i] = exact(points[2 * i + 1]) - exact(points[2 * i]);
  return CGAL::sign(dot(rows[0], cross(rows[1], rows[2])));
}

namespace {

template <class Number>
struct Point {
  Number x, y, z;
};

/// Clips the face by one half-space after the other (Sutherland and Hodgman 1974).
template <class N>
bool meets_as(const Triangle& face, const Eigen::Vector3d& origin,
              const std::vector<HalfSpace>& half_spaces) {
  std::vector<Point<N>> polygon;
  for (const Eigen::Vector3d& corner : face) {
    polygon.push_back({N(corner.x()) - N(origin.x()), N(corner.y()) - N(origin.y()),
                       N(corner.z()) - N(origin.z())});
  }
  for (const HalfSpace& half_space : half_spaces) {
    const N a(half_space.normal.x()), b(half_space.normal.y()), c(half_space.normal.z());
    const N offset(half_space.offset);
    std::vector<N> excess;
    for (const Point<N>& p : polygon) excess.push_back(a * p.x + b * p.y + c * p.z - offset);
    std::vector<Point<N>> inside;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const std::size_t next = (i + 1) % polygon.size();
      const bool here = excess[i] <= N(0), there = excess[next] <= N(0);
      const Point<N>&p = polygon[i], &q = polygon[next];
      if (here) inside.push_back(p);
      if (here == there) continue;
      const N t = excess[i] / (excess[i] - excess[next]);
      inside.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)});
    }
    polygon = std::move(inside);
    if (polygon.empty()) return false;
  }
  return true;
}

/// The same by interval arithmetic. Returns nothing if rounding could change the answer.
std::optional<bool> meets_by_intervals(const Triangle& face, const Eigen::Vector3d& origin,
                                       const std::vector<HalfSpace>& half_spaces) {
  const CGAL::Protect_FPU_rounding<true> protect;
  try {
    return meets_as<CGAL::Interval_nt<false>>(face, origin, half_spaces);
  } catch (const CGAL::Uncertain_conversion_exception&) {
    return std::nullopt;
  }
}

/// The eye of a perspective camera: the point where x, y and w are zero in clip coordinates.
Eigen::Vector3d eye(const Eigen::Matrix4d& clip) {
  Eigen::Matrix<double, 3, 4> rows;
  rows << clip.row(0), clip.row(1), clip.row(3);
  return -rows.leftCols<3>().inverse() * rows.col(3);
}

}  // namespace

bool meets(const Triangle& face, const Eigen::Vector3d& origin,
           const std::vector<HalfSpace>& half_spaces) {
  const std::optional<bool> certain = meets_by_intervals(face, origin, half_spaces);
  return certain ? *certain : meets_as<CGAL::Gmpq>(face, origin, half_spaces);
}

std::vector<HalfSpace> half_spaces(const ViewingVolume& volume, double extent, double share) {
  constexpr std::size_t kNear = 4, kFar = 5;
  std::vector<HalfSpace> planes;
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    planes.push_back(volume.half_space(i));
  }
  // In a perspective view, w is proportional to the depth in front of the eye. Otherwise, it is 1.
  const auto w = [&](const HalfSpace& plane) {
    return volume.clip().row(3).dot((plane.offset * plane.normal).homogeneous());
  };
  const double near = w(planes[kNear]), far = w(planes[kFar]);
  const double largest = far == near ? extent : extent + eye(volume.clip()).norm();
  const double rounding = 16.0 * std::ldexp(largest, -24);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    planes[i].offset += share * rounding * (i == kFar ? far / near : 1.0);
  }
  return planes;
}

}  // namespace organ_collision::oracle
