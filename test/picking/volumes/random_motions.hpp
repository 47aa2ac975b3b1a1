#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>
#include <random>
#include <vector>

#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/geometry/tool/oriented_box.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// Random numbers and vectors from a fixed seed.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  /// Log-uniform between `low` and `high`, which are positive.
  double magnitude(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(engine_); }
  Eigen::Vector3d direction() {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(engine_), normal(engine_), normal(engine_)).normalized();
  }

 private:
  std::mt19937_64 engine_;
};

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
inline constexpr std::array kMotionKinds = {
    MotionKind::kNone,       MotionKind::kSideways,     MotionKind::kWideSwing,
    MotionKind::kRandom,     MotionKind::kAlong,        MotionKind::kNearlyAlong,
    MotionKind::kOblique,    MotionKind::kTiny,         MotionKind::kTipAtTrocar,
    MotionKind::kPastTrocar, MotionKind::kMovingTrocar, MotionKind::kParallelShift,
    MotionKind::kGrid};

/// A motion of the given kind. Its trocar starts at the distance `offset` [m] from the frame's
/// origin.
inline ShaftMotion random_motion(MotionKind kind, double offset, Random& random) {
  const Eigen::Vector3d trocar = offset * random.direction();
  const double length = random.magnitude(0.01, 0.4);
  const Eigen::Vector3d axis = length * random.direction();
  const Eigen::Vector3d across = axis.cross(random.direction()).normalized();
  const double step = random.magnitude(1e-3, 0.2);
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
      return tip_moves(random.uniform(-2, 2) * axis +
                       random.magnitude(1e-12, 0.1) * length * across);
    case MotionKind::kOblique:
      return tip_moves(random.uniform(-2, 2) * axis + step * across);
    case MotionKind::kTiny:
      return tip_moves(random.magnitude(1e-12, 1e-3) * random.direction());
    case MotionKind::kTipAtTrocar: {
      const ShaftAxis point{trocar, trocar};
      const std::array<ShaftMotion, 3> cases = {{{point, start}, {start, point}, {point, point}}};
      return cases[static_cast<std::size_t>(random.below(3))];
    }
    case MotionKind::kPastTrocar:
      return tip_moves(-random.uniform(1, 3) * axis + random.magnitude(1e-9, 0.1) * across);
    case MotionKind::kMovingTrocar:
      return {start,
              {trocar + random.magnitude(1e-12, 0.1) * random.direction(),
               start.tip + random.magnitude(1e-12, 0.2) * random.direction()}};
    case MotionKind::kParallelShift: {
      const Eigen::Vector3d shift = random.magnitude(1e-12, 0.2) * random.direction();
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
  out << std::setprecision(17);
  const auto print = [&](const char* name, const Eigen::Vector3d& p) {
    out << name << " (" << p.x() << ", " << p.y() << ", " << p.z() << ") ";
  };
  print("start.trocar", motion.start.trocar);
  print("start.tip", motion.start.tip);
  print("end.trocar", motion.end.trocar);
  print("end.tip", motion.end.tip);
  return out;
}

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

/// The wedge of the paper's figure 7, built from the lines of the figure.
struct PaperHexahedron {
  PaperHexahedron(const ShaftMotion& motion, double radius)
      : s(radius), trocar(motion.start.trocar) {
    x = (motion.end.tip - motion.start.tip).normalized();
    const Eigen::Vector3d to_tip = motion.start.tip - trocar;
    z = (to_tip - x * x.dot(to_tip)).normalized();
    y = z.cross(x);
    height = z.dot(to_tip);
    start = x.dot(to_tip);
    end = x.dot(motion.end.tip - trocar);
  }

  Eigen::Vector3d at(double along, double up, double depth) const {
    return trocar + x * along + y * up + z * depth;
  }
  std::vector<Eigen::Vector3d> corners() const {
    return {at(-s, -s, 0),
            at(-s, s, 0),
            at(s, -s, 0),
            at(s, s, 0),
            at(start - s, -s, height),
            at(start - s, s, height),
            at(end + s, -s, height),
            at(end + s, s, height)};
  }
  bool contains(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p(x.dot(point - trocar), y.dot(point - trocar), z.dot(point - trocar));
    const double share = p.z() / height;
    return p.z() >= 0 && share <= 1 && std::abs(p.y()) <= s && p.x() >= share * start - s &&
           p.x() <= share * end + s;
  }

  double s;
  Eigen::Vector3d trocar, x, y, z;
  double height, start, end;
};

/// A motion for which the paper's swept volume exists: the trocar rests, the tip moves.
inline ShaftMotion paper_motion(Random& random) {
  const Eigen::Vector3d trocar = 0.3 * random.direction();
  const Eigen::Vector3d tip = trocar + random.uniform(0.05, 0.3) * random.direction();
  return {{trocar, tip}, {trocar, tip + random.uniform(0.002, 0.2) * random.direction()}};
}

}  // namespace organ_collision
