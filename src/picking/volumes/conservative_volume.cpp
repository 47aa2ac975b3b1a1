#include "conservative_volume.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "camera_axes.hpp"
#include "clipping_rounding.hpp"
#include "convex_hull.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The wedge serves a triangle of trocar and tips that is neither too thin nor too oblique for it.
// The box serves all other motions.
constexpr double kMinSine = 1e-3;       // [1] of the angle at the trocar
constexpr double kMinStep = 1e-3;       // [1] tip motion as a share of the axis length
constexpr double kMinForward = 0.3;     // [1] cosine between either axis and the view
constexpr double kMinNearShare = 1e-3;  // [1] near, as a share of far

// [1] A user plane that cuts off less than this share of the radius is left out, because it would
// cost more than it saves.
constexpr double kWorthCutting = 0.25;

// Both ends of the axis before and after the leg, relative to the first trocar [m].
struct Ends {
  explicit Ends(const ShaftMotion& motion)
      : origin(motion.start.trocar),
        trocar_end(motion.end.trocar - origin),
        tip_start(motion.start.tip - origin),
        tip_end(motion.end.tip - origin) {}

  double extent() const {
    return std::max({trocar_end.stableNorm(), tip_start.stableNorm(), tip_end.stableNorm()});
  }

  Vector3d origin, trocar_end, tip_start, tip_end;
};

// The wedge of the paper's section 4. Its sides are moved outward by the radius at right angles,
// its ends by the radius along the view. Returns nothing if the triangle is too thin or too
// oblique, or if the trocar moves. `extent` [m] is the largest coordinate of the motion and of the
// drawn faces.
std::optional<ViewingVolume> wedge(const Ends& ends, double radius, double extent,
                                   const Rounding& rounding) {
  const double longest = std::max(ends.tip_start.norm(), ends.tip_end.norm());
  const Vector3d step = ends.tip_end - ends.tip_start;
  if (!ends.trocar_end.isZero(0) || step.norm() < kMinStep * longest) return std::nullopt;
  const Vector3d start = ends.tip_start.normalized();
  const Vector3d end = ends.tip_end.normalized();
  if (!(start.cross(end).norm() >= kMinSine)) return std::nullopt;

  const Vector3d along = step.normalized();
  const Eigen::Matrix3d axes = camera_axes(start - along * along.dot(start), along);
  const Vector3d view = axes.col(2);
  if (std::min(view.dot(start), view.dot(end)) < kMinForward) return std::nullopt;
  const double left = axes.col(0).dot(start) / view.dot(start);
  const double right = axes.col(0).dot(end) / view.dot(end);

  // The sides meet on the bisector of the angle at the trocar, this many radii behind the trocar.
  const Vector3d bisector = (start + end).normalized();
  const double back = 2 / (end - start).norm();
  // A side's equation contains the depth times the side's slope, so the rounding of the depth
  // counts in proportion to the slope.
  const double slant = 1 + std::max(std::abs(left), std::abs(right));
  const double reach = std::max(extent, back * radius);
  const double grown = radius + rounding.plane * slant * reach;
  const Vector3d eye = -bisector * back * grown;
  const double near = -view.dot(eye) - grown;
  const double end_of_capsule = view.dot(ends.tip_start - eye) + grown;
  if (near < kMinNearShare * end_of_capsule) return std::nullopt;

  const double far = end_of_capsule + rounding.division * reach * end_of_capsule / near;
  ViewingVolume volume = ViewingVolume::perspective(
      {ends.origin, eye, axes, left * near, right * near, -grown, grown, near, far});
  volume.add_user_plane({axes.col(1), grown});
  volume.add_user_plane({-axes.col(1), grown});
  return volume;
}

// Camera axes of the box: z along the longer axis, x along the largest motion across it. The hull
// of a resting trocar and both tips is then flat in y.
Eigen::Matrix3d box_axes(const Ends& ends) {
  const Vector3d later = ends.tip_end - ends.trocar_end;
  Vector3d view = later.stableNorm() > ends.tip_start.stableNorm() ? later : ends.tip_start;
  if (view.isZero(0)) view = ends.trocar_end;
  if (view.isZero(0)) view = Vector3d::UnitZ();
  const Vector3d z = view.stableNormalized();
  const Vector3d tip_step = ends.tip_end - ends.tip_start;
  const bool tip_moves_more = (tip_step - z * z.dot(tip_step)).stableNorm() >
                              (ends.trocar_end - z * z.dot(ends.trocar_end)).stableNorm();
  return camera_axes(view, tip_moves_more ? tip_step : ends.trocar_end);
}

// A box around all positions of the axis, grown by the radius. User planes cut it along the edges
// of the hull of these positions, seen along y, each moved outward by the radius.
ViewingVolume cut_box(const Ends& ends, double radius, double extent, const Rounding& rounding) {
  const double grown = radius + rounding.plane * extent;
  const Eigen::Matrix3d axes = box_axes(ends);
  Eigen::Matrix<double, 3, 4> points;
  points << Vector3d::Zero(), ends.trocar_end, ends.tip_start, ends.tip_end;
  points = (axes.transpose() * points).eval();
  const Vector3d low = points.rowwise().minCoeff().array() - grown;
  const Vector3d high = points.rowwise().maxCoeff().array() + grown;
  ViewingVolume volume =
      ViewingVolume::orthographic({ends.origin, Vector3d::Zero(), axes, low.x(), high.x(), low.y(),
                                   high.y(), low.z(), high.z()});

  std::array<Vector2d, 4> outline;
  for (int i = 0; i < 4; ++i) outline[i] = {points(0, i), points(2, i)};
  const ConvexHull hull = convex_hull(outline);
  for (std::size_t i = 0; i < hull.count && hull.count > 1; ++i) {
    const Vector2d edge = hull.corners[(i + 1) % hull.count] - hull.corners[i];
    const Vector3d normal = Vector3d(edge.y(), 0, -edge.x()).stableNormalized();
    const double offset = (normal.transpose() * points).maxCoeff() + grown;
    const double box_offset = normal.cwiseProduct(low).cwiseMax(normal.cwiseProduct(high)).sum();
    if (box_offset - offset > kWorthCutting * radius) {
      volume.add_user_plane({axes * normal, offset});
    }
  }
  return volume;
}

ViewingVolume swept_volume(const ShaftMotion& motion, double radius, double extent,
                           const Rounding& rounding) {
  const Ends ends(motion);
  const double reach = std::max(extent, ends.extent() + radius);
  if (const auto volume = wedge(ends, radius, reach, rounding)) return *volume;
  return cut_box(ends, radius, reach, rounding);
}

}  // namespace

ViewingVolume conservative_volume(const ShaftMotion& motion, double radius,
                                  const VolumeMargin& margin) {
  return swept_volume(motion, radius + margin.motion, margin.extent, kClippingRounding);
}

ViewingVolume tool_volume(const ShaftMotion& motion, double radius) {
  return swept_volume(motion, radius, 0.0, kNoRounding);
}

}  // namespace organ_collision
