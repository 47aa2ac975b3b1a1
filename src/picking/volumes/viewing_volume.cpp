#include "viewing_volume.hpp"

#include <algorithm>

namespace organ_collision {
namespace {

// A camera coordinate as a row. The product of the row and (p, 1) is axis · (p - eye).
Eigen::RowVector4d coordinate(const ViewingVolume::Camera& camera, int axis) {
  const Eigen::Vector3d direction = camera.axes.col(axis);
  return {direction.x(), direction.y(), direction.z(), -direction.dot(camera.eye)};
}

const Eigen::RowVector4d kOne{0, 0, 0, 1};

}  // namespace

// The rows of glOrtho, for a camera that looks along +z.
ViewingVolume ViewingVolume::orthographic(const Camera& camera) {
  const auto& [origin, eye, axes, left, right, bottom, top, near, far] = camera;
  ViewingVolume volume;
  volume.origin_ = origin;
  volume.near_ = near;
  volume.far_ = far;
  volume.perspective_ = false;
  volume.clip_.row(0) = (2 * coordinate(camera, 0) - (right + left) * kOne) / (right - left);
  volume.clip_.row(1) = (2 * coordinate(camera, 1) - (top + bottom) * kOne) / (top - bottom);
  volume.clip_.row(2) = (2 * coordinate(camera, 2) - (far + near) * kOne) / (far - near);
  volume.clip_.row(3) = kOne;
  return volume;
}

// The rows of glFrustum, for a camera that looks along +z, divided by `near`. w is then 1 at the
// near plane, and no entry becomes very large or small, however far away the eye is.
ViewingVolume ViewingVolume::perspective(const Camera& camera) {
  const auto& [origin, eye, axes, left, right, bottom, top, near, far] = camera;
  ViewingVolume volume;
  volume.origin_ = origin;
  volume.near_ = near;
  volume.far_ = far;
  volume.perspective_ = true;
  const Eigen::RowVector4d w = coordinate(camera, 2) / near;
  volume.clip_.row(0) = (2 * coordinate(camera, 0) - (right + left) * w) / (right - left);
  volume.clip_.row(1) = (2 * coordinate(camera, 1) - (top + bottom) * w) / (top - bottom);
  volume.clip_.row(2) = ((far + near) * w - 2 * far * kOne) / (far - near);
  volume.clip_.row(3) = w;
  return volume;
}

void ViewingVolume::add_user_plane(const HalfSpace& half_space) {
  Eigen::Vector4d& plane = user_planes_.at(user_plane_count_);
  plane << -half_space.normal, half_space.offset;
  ++user_plane_count_;
}

HalfSpace ViewingVolume::half_space(std::size_t index) const {
  Eigen::RowVector4d inside;
  if (index < 6) {
    const auto row = clip_.row(static_cast<Eigen::Index>(index / 2));
    inside = index % 2 == 0 ? Eigen::RowVector4d(clip_.row(3) + row)
                            : Eigen::RowVector4d(clip_.row(3) - row);
  } else {
    inside = user_planes_.at(index - 6).transpose();
  }
  const double length = inside.head<3>().norm();
  return {-inside.head<3>().transpose() / length, inside(3) / length};
}

double ViewingVolume::view_depth(double window_depth) const {
  const double range = far_ - near_;
  const double depth = std::clamp(window_depth, 0.0, 1.0);
  if (!perspective_) return depth * range;
  // Equals far near / (far - depth range) - near, without cancellation.
  return near_ * depth * range / (near_ + (1.0 - depth) * range);
}

}  // namespace organ_collision
