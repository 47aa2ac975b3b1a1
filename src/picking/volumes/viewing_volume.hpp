#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// All points x with normal · x <= offset [m]. `normal` is unit and points outward.
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset;
};

/// What GL clips to: the frustum of a camera and up to eight user planes. A volume holds matrices
/// and half-spaces together, so that culling, GL and tests cannot disagree.
///
/// All coordinates are those of the organ's frame, shifted so that `origin` is zero. 32-bit
/// clipping loses a share of the largest coordinate, and the shift keeps that coordinate small.
class ViewingVolume {
 public:
  static constexpr std::size_t kMaxUserPlanes = 8;

  /// [m] The origin of the shifted coordinates, in the organ's frame.
  const Eigen::Vector3d& origin() const { return origin_; }
  /// The matrix from shifted coordinates to GL's clip coordinates. Inside, -w <= x, y, z <= w.
  const Eigen::Matrix4d& clip() const { return clip_; }
  /// The user planes as glClipPlane takes them: a b c d of a x + b y + c z + d >= 0 in shifted
  /// coordinates.
  const Eigen::Vector4d* user_planes() const { return user_planes_.data(); }
  std::size_t user_plane_count() const { return user_plane_count_; }

  /// The half-spaces of the volume in shifted coordinates: first the six frustum planes (left,
  /// right, bottom, top, near, far), from the rows of clip(), then the user planes.
  std::size_t half_space_count() const { return 6 + user_plane_count_; }
  HalfSpace half_space(std::size_t index) const;

  /// [m] How far a point lies behind the near plane, along the view. `window_depth` is its depth in
  /// GL's window coordinates, clamped to [0, 1] because of rounding.
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

  /// Adds a half-space, in shifted coordinates, to which the volume is clipped as well. Throws
  /// std::out_of_range if there are kMaxUserPlanes already.
  void add_user_plane(const HalfSpace& half_space);

 private:
  ViewingVolume(const Eigen::Vector3d& origin, double near, double far, bool perspective)
      : origin_(origin), near_(near), far_(far), perspective_(perspective) {}

  Eigen::Vector3d origin_;
  Eigen::Matrix4d clip_;
  std::array<Eigen::Vector4d, kMaxUserPlanes> user_planes_;
  std::size_t user_plane_count_ = 0;
  double near_, far_;
  bool perspective_;
};

/// A camera's axes: orthonormal columns x, y, z. z is along `view`, which is not zero. y points
/// towards the frame axis that is least aligned with z.
Eigen::Matrix3d camera_axes(const Eigen::Vector3d& view);

/// A camera's axes with x along the component of `right` that is perpendicular to `view`. If
/// `right` is parallel to `view`, the axes are camera_axes(view).
Eigen::Matrix3d camera_axes(const Eigen::Vector3d& view, const Eigen::Vector3d& right);

/// A face across the middle of the frustum, in the volume's shifted coordinates [m]. It meets the
/// volume, because no user plane of a tool's volume cuts off that middle. Exceptions are the
/// paper's naive volume, and slivers that are so thin for their length that 32-bit clipping loses
/// the face. See doc/theory/geometry.md, GL's clipping.
Triangle middle_face(const ViewingVolume& volume);

/// The part of a face in a viewing volume, in double precision. The face and its part are in the
/// volume's shifted coordinates [m]. A face that only touches the volume has such a part, too.
Region clipped(const Triangle& face, const ViewingVolume& volume);

/// The same for a face in the organ's frame.
Region region_of(const Triangle& face, const ViewingVolume& volume);

}  // namespace organ_collision
