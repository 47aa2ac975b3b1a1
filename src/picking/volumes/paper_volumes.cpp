#include "paper_volumes.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// [1] The tip rests if it moves by at most this share of the axis length or radius, whichever is
// larger. The trocar lies on the line through the tips if it is at most that far from it. In both
// cases only rounding would decide the directions of the hexahedron.
constexpr double kFlat = 1e-9;

// The least length and radius of a shaft [m], and the least radius as a share of the length [1].
// Rounding in 32-bit clipping would lose the volume of a smaller shaft.
constexpr double kLeastSize = 1e-9;
constexpr double kThinnest = 1e-6;

void check_size(double length, double radius) {
  if (!(length >= kLeastSize)) {
    throw std::invalid_argument(concatenate("trocar and tip are ", length,
                                            " m apart; the paper's volumes need at least ",
                                            kLeastSize, " m"));
  }
  const double thinnest = std::max(kThinnest * length, kLeastSize);
  if (!(radius >= thinnest)) {
    throw std::invalid_argument(concatenate("radius is ", radius,
                                            " m; the paper's volumes of a shaft of ", length,
                                            " m need at least ", thinnest, " m"));
  }
}

// The hexahedron of figure 4, seen from the trocar along z, with x along the tip's motion.
struct Hexahedron {
  Eigen::Matrix3d axes;
  double height;      // [m] depth of the line through the tips, along z
  double start, end;  // [m] x of the previous and of the current tip
  double travel() const { return end - start; }
};

// Follows section 4 of the paper. Returns nothing if the tip rests, or if the trocar lies on the
// line through the tips.
std::optional<Hexahedron> hexahedron(const ShaftMotion& motion, double radius) {
  const Vector3d previous = motion.start.along();
  const Vector3d current = motion.end.tip - motion.start.trocar;
  const double length = std::max(previous.norm(), current.norm());
  check_size(length, radius);
  const double flat = kFlat * std::max(length, radius);
  const Vector3d step = current - previous;
  if (step.norm() <= flat) return std::nullopt;
  const Vector3d along = step.normalized();
  const Vector3d away = previous - along * along.dot(previous);
  if (away.norm() <= flat) return std::nullopt;
  const Eigen::Matrix3d axes = camera_axes(away, along);
  return Hexahedron{axes, axes.col(2).dot(previous), axes.col(0).dot(previous),
                    axes.col(0).dot(current)};
}

ViewingVolume static_to_farther_tip(const ShaftMotion& motion, double radius) {
  const Vector3d& trocar = motion.start.trocar;
  const bool went_back = (motion.start.tip - trocar).norm() > (motion.end.tip - trocar).norm();
  return paper_static_volume({trocar, went_back ? motion.start.tip : motion.end.tip}, radius);
}

}  // namespace

ViewingVolume paper_static_volume(const ShaftAxis& axis, double radius) {
  const Vector3d view = axis.along();
  check_size(view.norm(), radius);
  return ViewingVolume::orthographic({axis.trocar, Vector3d::Zero(), camera_axes(view), -radius,
                                      radius, -radius, radius, 0, view.norm()});
}

ViewingVolume paper_swept_volume(const ShaftMotion& motion, double radius) {
  const auto solid = hexahedron(motion, radius);
  if (!solid) return static_to_farther_tip(motion, radius);
  // The sides meet behind the trocar. By the intercept theorem, their meeting point is `share`
  // times as far from the trocar, along z, as the tips are.
  const double share = 2 * radius / solid->travel();
  const double near = share * solid->height;
  const double left = share * solid->start;
  const Vector3d eye = solid->axes * Vector3d(-radius - left, 0, -near);
  ViewingVolume volume =
      ViewingVolume::perspective({motion.start.trocar, eye, solid->axes, left, left + 2 * radius,
                                  -radius, radius, near, near + solid->height});
  const Vector3d y = solid->axes.col(1);
  volume.add_user_plane({y, radius});
  volume.add_user_plane({-y, radius});
  return volume;
}

ViewingVolume paper_naive_volume(const ShaftMotion& motion, double radius) {
  const auto solid = hexahedron(motion, radius);
  if (!solid) return static_to_farther_tip(motion, radius);
  ViewingVolume volume = ViewingVolume::orthographic(
      {motion.start.trocar, Vector3d::Zero(), solid->axes, std::min(0.0, solid->start) - radius,
       std::max(0.0, solid->end) + radius, -radius, radius, 0, solid->height});
  // In x and z, a side goes through (outward * radius, 0) and (tip + outward * radius, height).
  const auto add_side = [&](double tip, double outward) {
    const Vector3d normal = solid->axes * (outward * Vector3d(solid->height, 0, -tip)).normalized();
    volume.add_user_plane({normal, outward * radius * normal.dot(solid->axes.col(0))});
  };
  add_side(solid->start, -1);
  add_side(solid->end, 1);
  return volume;
}

}  // namespace organ_collision
