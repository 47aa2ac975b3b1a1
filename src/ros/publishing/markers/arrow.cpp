#include "arrow.hpp"

#include <array>
#include <cmath>

#include "marker_sheet.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr int kSides = 6;
/// Shares of the arrow's length.
constexpr double kShaftRadius = 0.04;
constexpr double kHeadRadius = 0.11;
constexpr double kHeadLength = 0.3;

using Ring = std::array<Vector3d, kSides>;

/// Corners around `center`, counterclockwise seen against `axis`, a vector of length 1.
Ring ring(const Vector3d& center, const Vector3d& axis, double radius) {
  const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  Ring corners;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * M_PI * i / kSides;
    corners[i] = center + radius * (std::cos(angle) * u + std::sin(angle) * v);
  }
  return corners;
}

void add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                  visualization_msgs::Marker& list) {
  for (const Vector3d& corner : {a, b, c}) add_point(list, corner);
}

}  // namespace

void add_arrow(const Vector3d& tail, const Vector3d& head, visualization_msgs::Marker& list) {
  const double length = (head - tail).norm();
  if (!(length > 0.0)) return;
  const Vector3d axis = (head - tail) / length;
  const Vector3d neck = head - kHeadLength * length * axis;
  const Ring start = ring(tail, axis, kShaftRadius * length);
  const Ring end = ring(neck, axis, kShaftRadius * length);
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    add_triangle(tail, start[next], start[i], list);
    add_triangle(start[i], start[next], end[next], list);
    add_triangle(start[i], end[next], end[i], list);
  }
  add_arrow_head(neck, head, kHeadRadius * length, list);
}

void add_arrow_head(const Vector3d& base, const Vector3d& apex, double radius,
                    visualization_msgs::Marker& list) {
  const double length = (apex - base).norm();
  if (!(length > 0.0)) return;
  const Ring rim = ring(base, (apex - base) / length, radius);
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    add_triangle(base, rim[next], rim[i], list);
    add_triangle(rim[i], rim[next], apex, list);
  }
}

}  // namespace organ_collision
