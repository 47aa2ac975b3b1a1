#include "camera.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {
namespace {

/// [1] The part of the picture that automatic framing uses.
constexpr double kFilled = 0.94;
/// [m] The eye never comes closer to the target.
constexpr double kClosest = 1e-3;

double half_height() { return std::tan(0.5 * kFieldOfView); }

}  // namespace

Eigen::Matrix3d view_axes(const Eigen::Vector3d& to_eye, const Eigen::Vector3d& up) {
  return camera_axes(to_eye, up.normalized().cross(to_eye.normalized()));
}

Eigen::Vector3d centre(const PictureTriangles& triangles) {
  Eigen::AlignedBox3d box;
  for (const PictureVertex& vertex : triangles) box.extend(vertex.position);
  return box.center();
}

double framing_distance(const PictureTriangles& triangles, const Eigen::Vector3d& target,
                        const Eigen::Matrix3d& axes, double aspect) {
  const double height = kFilled * half_height();
  double distance = kClosest;
  for (const PictureVertex& vertex : triangles) {
    const Eigen::Vector3d p = axes.transpose() * (vertex.position - target);
    const double needed = std::max(std::abs(p.x()) / aspect, std::abs(p.y())) / height;
    distance = std::max(distance, p.z() + needed);
  }
  return distance;
}

Eigen::Matrix4d projection(double aspect, double near, double far) {
  Eigen::Matrix4d result = Eigen::Matrix4d::Zero();
  result(0, 0) = 1.0 / (aspect * half_height());
  result(1, 1) = 1.0 / half_height();
  result(2, 2) = -(far + near) / (far - near);
  result(2, 3) = -2.0 * far * near / (far - near);
  result(3, 2) = -1.0;
  return result;
}

}  // namespace organ_collision
