#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <iomanip>
#include <ostream>

#include "geometry/tool/rigid_motion.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/geometry/tool/oriented_box.hpp"
#include "random_motions.hpp"

namespace organ_collision {

/// A moving box of a link, with a radius.
struct MovingBox {
  OrientedBox box;  ///< in the link's frame
  Eigen::Isometry3d start, end;
  double radius;

  RigidMotion motion() const { return {start, end}; }
};

inline Eigen::Matrix3d random_rotation(double angle, Random& random) {
  return Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix();
}

/// A box that rests, moves straight, rotates by up to 3.1 rad, or both. Some boxes are flat, some
/// are points. The box starts at the distance `offset` [m] from the frame's origin.
inline MovingBox random_box(double offset, Random& random) {
  MovingBox moving;
  OrientedBox& box = moving.box;
  box.center = random.uniform(0, 0.1) * random.direction();
  box.axes = random_rotation(random.uniform(0, M_PI), random);
  for (int k = 0; k < 3; ++k) {
    box.half_size[k] = random.below(8) == 0 ? 0 : random.magnitude(1e-4, 0.1);
  }
  if (random.below(8) == 0) box.half_size.setZero();
  moving.radius = random.below(2) == 0 ? tolerance::kConvexMargin : random.magnitude(0.0005, 0.01);
  moving.start = Eigen::Isometry3d::Identity();
  moving.start.linear() = random_rotation(random.uniform(0, M_PI), random);
  moving.start.translation() = offset * random.direction();
  moving.end = moving.start;
  const int kind = random.below(4);
  if (kind % 2 == 1) moving.end.translation() += random.magnitude(1e-9, 0.2) * random.direction();
  if (kind >= 2) moving.end.linear() *= random_rotation(random.magnitude(1e-6, 3.1), random);
  return moving;
}

inline std::ostream& operator<<(std::ostream& out, const MovingBox& moving) {
  return out << std::setprecision(17) << "center " << moving.box.center.transpose() << "\naxes\n"
             << moving.box.axes << "\nhalf size " << moving.box.half_size.transpose() << "\nstart\n"
             << moving.start.matrix() << "\nend\n"
             << moving.end.matrix() << "\nradius " << moving.radius << '\n';
}

}  // namespace organ_collision
