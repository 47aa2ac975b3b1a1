#include "conservative_volume.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace organ_collision {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// [1] How far 32-bit clipping may displace the planes of a volume, as shares of the largest
/// coordinate. See doc/theory/geometry.md, Outcodes and 32-bit clipping.
struct Rounding {
  double plane;     ///< for any plane; in a wedge, times 1 plus its steeper slope
  double division;  ///< for the far plane of a wedge in addition, times far / near
};

// For frustum planes, the derived bound of both values is 14.4 / (1 << 24). In tests, faces at the
// boundary were missed with a tenth of the first value, and with a sixteenth of the second one.
constexpr Rounding kClippingRounding{1e-6, 16.0 / (1 << 24)};
constexpr Rounding kNoRounding{0.0, 0.0};

// The wedge is used if the triangle of trocar and tips is not too thin and not too oblique. All
// other motions get the box.
constexpr double kMinSine = 1e-3;       // [1] least sine of the angle at the trocar
constexpr double kMinStep = 1e-3;       // [1] least way of the tip, as a share of the longer axis
constexpr double kMinForward = 0.3;     // [1] least cosine between either axis and the view
constexpr double kMinNearShare = 1e-3;  // [1] least ratio of near to far

// [1] A user plane that cuts off less than this share of the radius is left out, because it would
// cost more than it saves.
constexpr double kWorthCutting = 0.25;

// Both ends of the axis before and after the leg [m], relative to the trocar before the leg.
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

// The wedge of the paper's section 4, but its sides and its ends are moved outward by the radius at
// right angles. Returns nothing if the triangle is too thin or too oblique, or if the trocar moves.
// `extent` [m] is the largest coordinate of the motion and of the drawn faces.
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

  // The sides meet on the bisector of the angle at the trocar, `back` radii behind the trocar.
  const Vector3d bisector = (start + end).normalized();
  const double back = 2 / (end - start).norm();
  // The equation of a side contains depth times slope, so the rounding of the depth grows with it.
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

// The camera axes of the box: z along the longer axis, x along the largest motion across z. If the
// trocar rests, all positions of the axis then lie in the x-z plane.
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

// A box around all positions of the axis, grown by the radius. User planes, also moved outward by
// the radius, cut it along the edges of the convex hull of these positions, seen along y.
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

  // The edges of the hull, counterclockwise from its leftmost corner. Follows Jarvis, "On the
  // identification of the convex hull of a finite set of points in the plane" (1973).
  const auto is_beyond = [&](const Vector3d& edge, const Vector3d& other) {
    const double turn = edge.x() * other.z() - edge.z() * other.x();
    return turn < 0 || (turn == 0 && Vector2d(other.x(), other.z()).norm() >
                                         Vector2d(edge.x(), edge.z()).norm());
  };
  int first = 0;
  for (int i = 1; i < 4; ++i) {
    const Vector3d other = points.col(i), leftmost = points.col(first);
    if (std::tie(other.x(), other.z()) < std::tie(leftmost.x(), leftmost.z())) first = i;
  }
  int from = first;
  for (int corner = 0; corner < 4; ++corner) {
    Vector3d edge = Vector3d::Zero();
    int to = from;
    for (int i = 0; i < 4; ++i) {
      const Vector3d other = points.col(i) - points.col(from);
      if (!is_beyond(edge, other)) continue;
      edge = other;
      to = i;
    }
    const Vector3d normal = Vector3d(edge.z(), 0, -edge.x()).stableNormalized();
    const double offset = (normal.transpose() * points).maxCoeff() + grown;
    const double box_offset = normal.cwiseProduct(low).cwiseMax(normal.cwiseProduct(high)).sum();
    if (box_offset - offset > kWorthCutting * radius) {
      volume.add_user_plane({axes * normal, offset});
    }
    from = to;
    if (from == first) break;
  }
  return volume;
}

// If the ends of the axis move on arcs, the volume of their linear motion is grown by the
// deviation.
ViewingVolume volume_of(const SweptShaft& shaft, const VolumeMargin& margin,
                        const Rounding& rounding) {
  const double radius = shaft.radius + margin.motion + shaft.motion.deviation();
  const Ends ends(shaft.motion);
  const double reach = std::max(margin.extent, ends.extent() + radius);
  if (const auto volume = wedge(ends, radius, reach, rounding)) return *volume;
  return cut_box(ends, radius, reach, rounding);
}

/// An orthographic box.
ViewingVolume volume_of(const SweptBox& box, const VolumeMargin& margin, const Rounding& rounding) {
  const Eigen::Vector3d origin = box.axes().transpose() * box.origin();
  const Eigen::Vector3d low = box.low() - origin, high = box.high() - origin;
  const double reach =
      std::max({margin.extent, low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()});
  const double grown = margin.motion + rounding.plane * reach;
  return ViewingVolume::orthographic({box.origin(), Eigen::Vector3d::Zero(), box.axes(),
                                      low.x() - grown, high.x() + grown, low.y() - grown,
                                      high.y() + grown, low.z() - grown, high.z() + grown});
}

}  // namespace

PartSweep::PartSweep(const SweptBox& box) : space_(box), origin_(box.origin()) {
  Eigen::Vector3d edges = box.high() - box.low();
  std::sort(edges.data(), edges.data() + edges.size());
  thickness_ = 0.5 * edges[1];
}

ViewingVolume PartSweep::volume(const VolumeMargin& margin) const {
  return std::visit([&](const auto& space) { return volume_of(space, margin, kClippingRounding); },
                    space_);
}

ViewingVolume PartSweep::tool_volume() const {
  return std::visit([](const auto& space) { return volume_of(space, {}, kNoRounding); }, space_);
}

}  // namespace organ_collision
