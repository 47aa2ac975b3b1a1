#include "triangle_crossing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "organ_collision/geometry/tolerances.hpp"
#include "separating_plane.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// Where the border of a triangle passes through a plane.
struct BorderPoint {
  Vector3d point;   ///< [m]
  int from, to;     ///< the corners of the edge
  double fraction;  ///< the place on the edge, in [0, 1] from corner `from` to corner `to`
  double along;     ///< the place on the line in which the planes of both triangles meet
};

/// The segment in which a triangle cuts a plane: its ends, the one with the smaller `along` first.
using Section = std::array<BorderPoint, 2>;

/// The lower bound of the distance that the caller asked for.
ClosestPoints farther(double distance) {
  ClosestPoints closest{distance, 0.0, Vector3d::Zero(), Vector3d::Zero(), {}, Vector3d::Zero()};
  closest.steps = 1;
  return closest;
}

/// For each corner, how far it lies in front of a plane through `point`, times the length of
/// `normal`.
Vector3d heights(const Triangle& corners, const Vector3d& normal, const Vector3d& point) {
  return {normal.dot(corners[0] - point), normal.dot(corners[1] - point),
          normal.dot(corners[2] - point)};
}

/// Whether no plane passes between corners with these heights.
bool is_on_one_side(const Vector3d& heights) {
  return (heights.array() > 0.0).all() || (heights.array() <= 0.0).all();
}

/// Cuts a triangle by a plane. Not all corners are on one side. `direction`: of the line in which
/// the triangle's plane meets the other one.
Section cut(const Triangle& corners, const Vector3d& heights, const Vector3d& direction,
            const Vector3d& origin) {
  // The lone corner is the one on its own side of the plane.
  const bool side[] = {heights[0] > 0.0, heights[1] > 0.0, heights[2] > 0.0};
  const int lone = side[1] == side[2] ? 0 : side[0] == side[2] ? 1 : 2;
  Section section;
  for (int end = 0; end < 2; ++end) {
    const int to = (lone + 1 + end) % 3;
    const double fraction = heights[lone] / (heights[lone] - heights[to]);
    const Vector3d point = corners[lone] + fraction * (corners[to] - corners[lone]);
    section[end] = {point, lone, to, fraction, direction.dot(point - origin)};
  }
  if (section[1].along < section[0].along) std::swap(section[0], section[1]);
  return section;
}

/// The place on a section at `along`, in [0, 1] from its first end to its second one.
double place_at(const Section& section, double along) {
  const double length = section[1].along - section[0].along;
  if (!(length > 0.0)) return 0.0;
  return std::clamp((along - section[0].along) / length, 0.0, 1.0);
}

Vector3d point_at(const Section& section, double place) {
  return section[0].point + place * (section[1].point - section[0].point);
}

/// The weights of the triangle's corners at a place of its section.
Vector3d barycentric_at(const Section& section, double place) {
  Vector3d weights = Vector3d::Zero();
  for (int end = 0; end < 2; ++end) {
    const BorderPoint& border = section[end];
    const double share = end == 0 ? 1.0 - place : place;
    weights[border.from] += share * (1.0 - border.fraction);
    weights[border.to] += share * border.fraction;
  }
  return weights;
}

/// [m] How far the plane along two edges keeps the triangles apart; 0 if it does not.
double gap_between(const Triangle& core, const BorderPoint& of_core, const Triangle& face,
                   const BorderPoint& of_face) {
  const Vector3d across =
      (core[of_core.to] - core[of_core.from]).cross(face[of_face.to] - face[of_face.from]);
  const double length = across.norm();
  if (!(length > 0.0)) return 0.0;
  // Relative to a corner, the projections lose least to rounding.
  const Vector3d& origin = face[of_face.from];
  const ProjectionInterval a = project_onto(across, shifted(core, origin));
  const ProjectionInterval b = project_onto(across, shifted(face, origin));
  return std::max({0.0, a.low - b.high, b.low - a.high}) / length;
}

}  // namespace

std::optional<ClosestPoints> triangle_crossing(const Triangle& core, const Triangle& face,
                                               double distance_bound) {
  const Vector3d core_normal = twice_area(core), face_normal = twice_area(face);
  const Vector3d of_core = heights(core, face_normal, face[0]);
  if (is_on_one_side(of_core)) return std::nullopt;
  const Vector3d of_face = heights(face, core_normal, core[0]);
  if (is_on_one_side(of_face)) return std::nullopt;

  const Vector3d direction = core_normal.cross(face_normal);
  const Section a = cut(core, of_core, direction, face[0]);
  const Section b = cut(face, of_face, direction, face[0]);
  const double begin = std::max(a[0].along, b[0].along), end = std::min(a[1].along, b[1].along);
  if (begin > end) {
    const bool face_first = b[1].along < a[0].along;
    const double gap =
        face_first ? gap_between(core, a[0], face, b[1]) : gap_between(core, a[1], face, b[0]);
    if (gap > distance_bound) return farther(gap);
    return std::nullopt;
  }
  const double middle = 0.5 * (begin + end);
  const double place = place_at(b, middle);
  ClosestPoints common{0.0, 0.0, barycentric_at(b, place), point_at(a, place_at(a, middle)),
                       {},  {}};
  common.on_face = organ_collision::point_at(face, common.barycentric);
  common.separation = common.on_face - common.on_core;
  common.distance = common.separation.norm();
  common.steps = 1;
  if (!(common.distance <= tolerance::kTie)) return std::nullopt;
  return common;
}

}  // namespace organ_collision
