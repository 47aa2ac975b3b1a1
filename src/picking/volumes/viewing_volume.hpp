#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "geometry/half_space.hpp"

namespace organ_collision {

/// What GL clips to: the frustum of a camera and up to eight user planes. A volume holds matrices
/// and half-spaces together, so that culling, GL and tests cannot disagree.
///
/// All coordinates are those of the organ's frame, shifted so that `origin` is zero. 32-bit
/// clipping loses a share of the largest coordinate, and the shift keeps that coordinate small.
class ViewingVolume {
 public:
  static constexpr std::size_t kMaxUserPlanes = 8;

  /// [m] In the organ's frame: subtract it from a point to get shifted coordinates.
  const Eigen::Vector3d& origin() const { return origin_; }
  /// From shifted coordinates to GL's clip coordinates. A point is inside if -w <= x, y, z <= w.
  const Eigen::Matrix4d& clip() const { return clip_; }
  /// The coefficients a b c d of a x + b y + c z + d >= 0 in shifted coordinates, as glClipPlane
  /// takes them.
  const Eigen::Vector4d* user_planes() const { return user_planes_.data(); }
  std::size_t user_plane_count() const { return user_plane_count_; }

  /// The same volume as half-spaces in shifted coordinates: first the six frustum planes (left,
  /// right, bottom, top, near, far), which follow from the rows of clip(), then the user planes.
  std::size_t half_space_count() const { return 6 + user_plane_count_; }
  HalfSpace half_space(std::size_t index) const;

  /// [m] How far a point lies behind the near plane, along the view. `window_depth` is its depth in
  /// GL's window coordinates, in [0, 1]. Values that rounding has put outside are clamped.
  double view_depth(double window_depth) const;

  /// A camera at `eye` (shifted coordinates) with orthonormal axes x (right), y (up) and
  /// z (along the view). The bounds are those of glOrtho and glFrustum, in metres.
  struct Camera {
    Eigen::Vector3d origin;
    Eigen::Vector3d eye;
    Eigen::Matrix3d axes;  ///< columns x, y, z
    double left, right, bottom, top, near, far;
  };
  static ViewingVolume orthographic(const Camera& camera);
  static ViewingVolume perspective(const Camera& camera);

  /// Adds { x : normal · x <= offset }, in shifted coordinates. Throws std::out_of_range if there
  /// are kMaxUserPlanes already.
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

}  // namespace organ_collision
