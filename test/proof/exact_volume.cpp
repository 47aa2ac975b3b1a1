#include "exact_volume.hpp"

#include <CGAL/Gmpq.h>
#include <CGAL/Interval_nt.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace organ_collision::oracle {
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
