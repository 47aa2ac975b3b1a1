#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <stdexcept>

#include "geometry/distance/swept_box.hpp"
#include "geometry/half_space.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

namespace organ_collision {

/// What GL clips to: the frustum of a camera and up to eight user planes. Made by the builders
/// below only, so that culling, GL and tests cannot disagree.
///
/// All coordinates are the organ frame's, shifted so that `origin` is zero: 32-bit clipping loses a
/// share of the largest coordinate, which the shift keeps small.
class ViewingVolume {
 public:
  static constexpr std::size_t kMaxUserPlanes = 8;

  const Eigen::Vector3d& origin() const { return origin_; }
  /// Shifted coordinates to GL clip coordinates: inside where -w <= x, y, z <= w.
  const Eigen::Matrix4d& clip() const { return clip_; }
  /// a b c d of a x + b y + c z + d >= 0, in shifted coordinates; as glClipPlane takes them.
  const Eigen::Vector4d* user_planes() const { return user_planes_.data(); }
  std::size_t user_plane_count() const { return user_plane_count_; }

  /// The same volume as half-spaces in shifted coordinates: the six frustum planes (left, right,
  /// bottom, top, near, far: the rows of `clip`), then the user planes.
  std::size_t half_space_count() const { return 6 + user_plane_count_; }
  HalfSpace half_space(std::size_t index) const;

  /// [m] Distance behind the near plane, along the view, of a point at GL's window depth.
  /// `window_depth` in [0, 1]; what rounding leaves beyond counts as at the plane.
  double view_depth(double window_depth) const;

  /// A camera at `eye` (shifted coordinates) with orthonormal axes x (right), y (up) and
  /// z (along the view). Bounds in metres as glOrtho and glFrustum take them.
  struct Camera {
    Eigen::Vector3d origin;
    Eigen::Vector3d eye;
    Eigen::Matrix3d axes;  ///< columns x, y, z
    double left, right, bottom, top, near, far;
  };
  static ViewingVolume orthographic(const Camera& camera);
  static ViewingVolume perspective(const Camera& camera);

  /// Adds { x : normal · x <= offset }, in shifted coordinates.
  void add_user_plane(const HalfSpace& half_space);

 private:
  ViewingVolume() = default;
  Eigen::Vector3d origin_;
  Eigen::Matrix4d clip_;
  std::array<Eigen::Vector4d, kMaxUserPlanes> user_planes_;
  std::size_t user_plane_count_ = 0;
  double near_, far_;
  bool perspective_;
};

/// A motion for which the asked volume does not exist (paper volumes of a tool without length or
/// thickness). what() names the value and what is legal.
class VolumeError : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// The 1999 paper's volumes, to the letter: they miss some faces near a swept tool's sides and end,
/// and are not grown for 32-bit clipping. Radius in metres. Throw VolumeError where 32-bit clipping
/// makes nothing of them: trocar and tip within 1e-9 m of each other, a radius less than that or
/// than a millionth of the shaft's length.
///
/// Static (section 3): a box of half-width `radius` around the axis, flat at both ends.
ViewingVolume paper_static_volume(const ShaftAxis& axis, double radius);
/// Swept (section 4, figures 7 and 8): a perspective camera and two user planes. The trocar rests
/// at `motion.start.trocar`. Without motion the static one; with trocar and both tips on a line the
/// static one to the farther tip.
ViewingVolume paper_swept_volume(const ShaftMotion& motion, double radius);
/// Swept, naive (figure 5): the orthographic box around the same hexahedron and two user planes
/// along its sides.
ViewingVolume paper_naive_volume(const ShaftMotion& motion, double radius);

/// How far the conservative volumes grow.
struct VolumeMargin {
  double motion = 0.0;  ///< [m] the farthest of a face, at any time, from where it is drawn
  double extent = 0.0;  ///< [m] largest coordinate of any drawn vertex relative to the origin
};

/// Contains every point within `radius` + margin.motion of the axis at some time of the leg, for
/// every motion: trocar moving or not, tip at the trocar, no motion, motion along the axis. Grown
/// so that 32-bit clipping of vertices up to `margin.extent` from the trocar loses nothing. Static:
/// a leg without motion.
ViewingVolume conservative_volume(const ShaftMotion& motion, double radius,
                                  const VolumeMargin& margin);

/// The same for a box of a link: contains it, grown by its radius, at every time of the leg. An
/// orthographic box.
ViewingVolume conservative_volume(const SweptBox& box, const VolumeMargin& margin);

/// The conservative volumes without their margins: the tool's own, as near as six frustum planes
/// and user planes can be to the swept capsule, or the box. What regions are clipped to.
ViewingVolume tool_volume(const ShaftMotion& motion, double radius);
ViewingVolume tool_volume(const SweptBox& box);

}  // namespace organ_collision
