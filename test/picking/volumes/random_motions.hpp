#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <random>

#include "organ_collision/geometry/tool/shaft.hpp"

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

}  // namespace organ_collision
