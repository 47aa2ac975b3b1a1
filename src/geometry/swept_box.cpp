#include "organ_collision/geometry/swept_box.hpp"

#include <Eigen/Geometry>

namespace organ_collision {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// [m] Of any point of the box, as CoreMotion::bend.
double bend(const OrientedBox& box, const RigidMotion& motion) {
  return (box.center.norm() + box.half_size.norm()) * motion.angle() * motion.angle() / 8.0;
}

/// Coordinates of the face's corners along the axes: a column for each.
Matrix3d along(const Matrix3d& axes, const Triangle& face) {
  Matrix3d corners;
  corners << face[0], face[1], face[2];
  return axes.transpose() * corners;
}

Vector3d face_normal(const Triangle& face) {
  return (face[1] - face[0]).cross(face[2] - face[0]).stableNormalized();
}

}  // namespace

SweptBox::SweptBox(const OrientedBox& box, const RigidMotion& motion, double radius)
    : axes_(motion.at(0.5).linear() * box.axes),
      start_(place(box, motion.start())),
      end_(place(box, motion.end())),
      reach_(radius + bend(box, motion)) {}

SweptBox::Place SweptBox::place(const OrientedBox& box, const Eigen::Isometry3d& pose) const {
  Place place;
  place.center = pose * box.center;
  place.half_edges = pose.linear() * box.axes * box.half_size.asDiagonal();
  const Vector3d center = axes_.transpose() * place.center;
  const Vector3d half = (axes_.transpose() * place.half_edges).cwiseAbs().rowwise().sum();
  place.low = center - half;
  place.high = center + half;
  return place;
}

bool SweptBox::stays_clear_of(const FaceMotion& face) const {
  const Matrix3d from = along(axes_, face.start), to = along(axes_, face.end);
  const Vector3d above =
      (from.rowwise().minCoeff() - start_.high).cwiseMin(to.rowwise().minCoeff() - end_.high);
  const Vector3d below =
      (start_.low - from.rowwise().maxCoeff()).cwiseMin(end_.low - to.rowwise().maxCoeff());
  if (above.cwiseMax(below).maxCoeff() > reach_) return true;

  const Vector3d normal = face_normal(face.start);
  const auto gap = [&](const Place& box, const Triangle& corners, double side) {
    const double reach = (normal.transpose() * box.half_edges).cwiseAbs().sum();
    double nearest = side * normal.dot(corners[0] - box.center);
    for (int i = 1; i < 3; ++i) {
      nearest = std::min(nearest, side * normal.dot(corners[i] - box.center));
    }
    return nearest - reach;
  };
  for (const double side : {1.0, -1.0}) {
    if (gap(start_, face.start, side) > reach_ && gap(end_, face.end, side) > reach_) return true;
  }
  return false;
}

}  // namespace organ_collision
