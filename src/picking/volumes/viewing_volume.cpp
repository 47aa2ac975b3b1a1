#include "viewing_volume.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

namespace organ_collision {
namespace {

// A camera coordinate as a row: the row times (p, 1) is axis · (p - eye).
Eigen::RowVector4d coordinate(const ViewingVolume::Camera& camera, int axis) {
  const Eigen::Vector3d direction = camera.axes.col(axis);
  return {direction.x(), direction.y(), direction.z(), -direction.dot(camera.eye)};
}

const Eigen::RowVector4d kOne{0, 0, 0, 1};

// [1] A vector counts as parallel to the view below this sine of the angle between both. Its
// component across the view is then only rounding.
constexpr double kParallel = 1e-12;

// [1] Corners of a polygon count as one corner if they differ by at most this share of their
// largest coordinate: only rounding separates them.
constexpr double kSameCorner = 1e-15;

void add_corner(const Eigen::Vector3d& corner, Region& polygon) {
  const auto is_same = [&](const Eigen::Vector3d& other) {
    return (corner - other).cwiseAbs().maxCoeff() <= kSameCorner * corner.cwiseAbs().maxCoeff();
  };
  if (polygon.empty() || !(is_same(polygon.back()) || is_same(polygon.front()))) {
    polygon.push_back(corner);
  }
}

/// Clips a convex polygon to a half-space. Source: Sutherland and Hodgman, "Reentrant polygon
/// clipping" (1974).
Region clipped(const Region& polygon, const HalfSpace& half_space) {
  const auto height = [&](const Eigen::Vector3d& corner) {
    return half_space.normal.dot(corner) - half_space.offset;
  };
  Region inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& from = polygon[i];
    const Eigen::Vector3d& to = polygon[(i + 1) % polygon.size()];
    const double begin = height(from), end = height(to);
    if (begin <= 0.0) add_corner(from, inside);
    if ((begin < 0.0 && end > 0.0) || (begin > 0.0 && end < 0.0)) {
      add_corner(from + begin / (begin - end) * (to - from), inside);
    }
  }
  return inside;
}

}  // namespace

// The rows of the matrix of glOrtho, for a camera that looks along +z.
ViewingVolume ViewingVolume::orthographic(const Camera& camera) {
  const auto& [origin, eye, axes, left, right, bottom, top, near, far] = camera;
  ViewingVolume volume(origin, near, far, false);
  volume.clip_.row(0) = (2 * coordinate(camera, 0) - (right + left) * kOne) / (right - left);
  volume.clip_.row(1) = (2 * coordinate(camera, 1) - (top + bottom) * kOne) / (top - bottom);
  volume.clip_.row(2) = (2 * coordinate(camera, 2) - (far + near) * kOne) / (far - near);
  volume.clip_.row(3) = kOne;
  return volume;
}

// The rows of the matrix of glFrustum, for a camera that looks along +z, divided by `near`. So w is
// 1 at the near plane, and no entry becomes very large or small, however far away the eye is.
ViewingVolume ViewingVolume::perspective(const Camera& camera) {
  const auto& [origin, eye, axes, left, right, bottom, top, near, far] = camera;
  ViewingVolume volume(origin, near, far, true);
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
  // This equals far near / (far - depth range) - near, but subtracts no similar numbers.
  return near_ * depth * range / (near_ + (1.0 - depth) * range);
}

Eigen::Matrix3d camera_axes(const Eigen::Vector3d& view) {
  const Eigen::Vector3d z = view.stableNormalized();
  Eigen::Index least_aligned;
  z.cwiseAbs().minCoeff(&least_aligned);
  const Eigen::Vector3d x = Eigen::Vector3d::Unit(least_aligned).cross(z).normalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  return axes;
}

Eigen::Matrix3d camera_axes(const Eigen::Vector3d& view, const Eigen::Vector3d& right) {
  const Eigen::Vector3d z = view.stableNormalized();
  Eigen::Vector3d x = right.stableNormalized();
  x -= z * z.dot(x);
  if (x.norm() < kParallel) return camera_axes(view);
  // This is repeated because the first subtraction loses most digits of a nearly parallel vector.
  x = x.stableNormalized();
  x = Eigen::Vector3d(x - z * z.dot(x)).stableNormalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  return axes;
}

Triangle middle_face(const ViewingVolume& volume) {
  Eigen::Matrix<double, 4, 3> corners;  // in clip coordinates, around the middle
  corners << -0.5, 0.5, 0.0,            //
      -0.5, -0.5, 1.0,                  //
      0.0, 0.0, 0.0,                    //
      1.0, 1.0, 1.0;
  corners = (volume.clip().inverse() * corners).eval();
  const auto point = [&](Eigen::Index i) -> Eigen::Vector3d {
    return corners.col(i).hnormalized();
  };
  return {point(0), point(1), point(2)};
}

Region clipped(const Triangle& face, const ViewingVolume& volume) {
  Region polygon(face.begin(), face.end());
  for (std::size_t i = 0; i < volume.half_space_count() && !polygon.empty(); ++i) {
    polygon = clipped(polygon, volume.half_space(i));
  }
  return polygon;
}

Region region_of(const Triangle& face, const ViewingVolume& volume) {
  Region region = clipped(shifted(face, volume.origin()), volume);
  for (Eigen::Vector3d& corner : region) corner += volume.origin();
  return region;
}

}  // namespace organ_collision
