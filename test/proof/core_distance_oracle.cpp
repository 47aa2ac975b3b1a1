#include "core_distance_oracle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "exact_distance.hpp"
#include "rounded_distance.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

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
