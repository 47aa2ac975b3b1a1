#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>

#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {

using oracle::Random;

enum class MotionKind {
  kNone,
  kSideways,
  kWideSwing,
  kRandom,
  kAlong,
  kNearlyAlong,
  kOblique,
  kTiny,
  kTipAtTrocar,
  kPastTrocar,
  kMovingTrocar,
  kParallelShift,
  kGrid
};

/// Each kind in turn.
inline MotionKind motion_kind(int number) { return static_cast<MotionKind>(number % 13); }

/// A motion of the given kind. Its trocar starts at the distance `offset` [m] from the frame's
/// origin.
inline ShaftMotion random_motion(MotionKind kind, double offset, Random& random) {
  const Eigen::Vector3d trocar = offset * random.direction();
  const double length = random.scale(0.01, 0.4);
  const Eigen::Vector3d axis = length * random.direction();
  const Eigen::Vector3d across = axis.cross(random.direction()).normalized();
  const double step = random.scale(1e-3, 0.2);
  const ShaftAxis start{trocar, trocar + axis};
  const auto tip_moves = [&](const Eigen::Vector3d& by) {
    return ShaftMotion{start, {trocar, start.tip + by}};
  };
  switch (kind) {
    case MotionKind::kNone:
      return {start, start};
    case MotionKind::kSideways:
      return tip_moves(step * across);
    case MotionKind::kWideSwing: {
      const double angle = random.uniform(0.2, 2.5);
      return tip_moves(std::cos(angle) * axis + length * std::sin(angle) * across - axis);
    }
    case MotionKind::kRandom:
      return tip_moves(step * random.direction());
    case MotionKind::kAlong:
      return tip_moves(random.uniform(-0.9, 2) * axis);
    case MotionKind::kNearlyAlong:
      return tip_moves(random.uniform(-2, 2) * axis + random.scale(1e-12, 0.1) * length * across);
    case MotionKind::kOblique:
      return tip_moves(random.uniform(-2, 2) * axis + step * across);
    case MotionKind::kTiny:
      return tip_moves(random.scale(1e-12, 1e-3) * random.direction());
    case MotionKind::kTipAtTrocar: {
      const ShaftAxis point{trocar, trocar};
      const std::array<ShaftMotion, 3> cases = {{{point, start}, {start, point}, {point, point}}};
      return cases[static_cast<std::size_t>(random.integer(0, 2))];
    }
    case MotionKind::kPastTrocar:
      return tip_moves(-random.uniform(1, 3) * axis + random.scale(1e-9, 0.1) * across);
    case MotionKind::kMovingTrocar:
      return {start,
              {trocar + random.scale(1e-12, 0.1) * random.direction(),
               start.tip + random.scale(1e-12, 0.2) * random.direction()}};
    case MotionKind::kParallelShift: {
      const Eigen::Vector3d shift = random.scale(1e-12, 0.2) * random.direction();
      return {start, {start.trocar + shift, start.tip + shift}};
    }
    case MotionKind::kGrid: {
      // Points on a coarse grid: exactly along the axis, exactly perpendicular to it, exactly at
      // the trocar.
      const auto snap = [&](const Eigen::Vector3d& near) -> Eigen::Vector3d {
        return (32 * (near + 0.1 * random.direction())).array().round() / 32;
      };
      const Eigen::Vector3d fixed = snap(trocar);
      return {{fixed, snap(trocar)}, {fixed, snap(trocar)}};
    }
  }
  return {start, start};
}

inline std::ostream& operator<<(std::ostream& out, const ShaftMotion& motion) {
  return out << "trocars and tips"
             << oracle::text_of_all(std::array{motion.start.trocar, motion.start.tip,
                                               motion.end.trocar, motion.end.tip})
             << ' ';
}

/// A moving box of a link, with a radius.
struct MovingBox {
  OrientedBox box;  ///< in the link's frame
  Eigen::Isometry3d start, end;
  double radius;

  RigidMotion motion() const { return {start, end}; }
};

/// A box that rests, moves straight, rotates by up to 3.1 rad, or both. Some boxes are flat, some
/// are points. The box starts at the distance `offset` [m] from the frame's origin.
inline MovingBox random_box(double offset, Random& random) {
  MovingBox moving;
  OrientedBox& box = moving.box;
  box.center = random.uniform(0, 0.1) * random.direction();
  box.axes = oracle::random_turn(random.uniform(0, M_PI), random);
  for (int k = 0; k < 3; ++k) {
    box.half_size[k] = random.chance(0.1) ? 0 : random.scale(1e-4, 0.1);
  }
  if (random.chance(0.1)) box.half_size.setZero();
  moving.radius = random.chance(0.5) ? tolerance::kConvexMargin : random.scale(0.0005, 0.01);
  moving.start = oracle::random_pose(0.0, random);
  moving.start.translation() = offset * random.direction();
  moving.end = moving.start;
  const int kind = random.integer(0, 3);
  if (kind % 2 == 1) moving.end.translation() += random.scale(1e-9, 0.2) * random.direction();
  if (kind >= 2) moving.end.linear() *= oracle::random_turn(random.scale(1e-6, 3.1), random);
  return moving;
}

inline std::ostream& operator<<(std::ostream& out, const MovingBox& moving) {
  return out << std::setprecision(17) << "center " << moving.box.center.transpose() << "\naxes\n"
             << moving.box.axes << "\nhalf size " << moving.box.half_size.transpose() << "\nstart\n"
             << moving.start.matrix() << "\nend\n"
             << moving.end.matrix() << "\nradius " << moving.radius << '\n';
}

/// [m] The largest signed distance of a point (in the organ's frame) from the half-spaces of a
/// volume. Negative: the point is inside the volume.
inline double excess(const ViewingVolume& volume, const Eigen::Vector3d& point) {
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    const HalfSpace half_space = volume.half_space(i);
    largest = std::max(largest, half_space.normal.dot(point - volume.origin()) - half_space.offset);
  }
  return largest;
}

}  // namespace organ_collision
