#pragma once

#include <cmath>

#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {

/// A face and an axis near it. Most are in special position.
struct SideTrial {
  Triangle face;
  ShaftAxis axis;
};

inline Eigen::Vector3d as_vertex(const Eigen::Vector3d& point) {
  return point.cast<float>().cast<double>();
}

inline Eigen::Vector3d grid_point(int most, oracle::Random& random) {
  return Eigen::Vector3d(random.integer(-most, most), random.integer(-most, most),
                         random.integer(-most, most));
}

inline SideTrial make_side_trial(oracle::Random& random) {
  SideTrial trial;
  Triangle& face = trial.face;
  ShaftAxis& axis = trial.axis;
  if (random.chance(0.4)) {
    // Points on a coarse grid: most trials have an edge, a corner or an end in a special position,
    // and many faces are degenerate.
    const double spacing = std::ldexp(random.chance(0.5) ? 1.0 : 3.0, random.integer(-140, 15));
    for (Eigen::Vector3d& corner : face) corner = spacing * grid_point(2, random);
    return {face, {spacing * grid_point(3, random), spacing * grid_point(3, random)}};
  }
  const Eigen::Vector3d center = random.chance(0.2) ? random.point(1e5) : random.point(0.1);
  const double size = random.scale(1e-4, 0.1);
  for (Eigen::Vector3d& corner : face) corner = as_vertex(center + size * random.direction());
  if (random.chance(0.2)) {
    face[2] = as_vertex(face[0] + random.uniform(-1, 2) * (face[1] - face[0]));  // a sliver
  }
  const double a = random.uniform(-0.2, 1.0), b = random.uniform(-0.2, 1.0);
  Eigen::Vector3d aim = face[0] + a * (face[1] - face[0]) + b * (face[2] - face[0]);
  const int kind = random.integer(0, 4);
  if (kind == 1) aim = face[random.integer(0, 2)];
  if (kind == 2) aim = 0.5 * (face[0] + face[1]);  // exact for most vertices
  if (kind == 3) aim = face[1] + random.scale(1e-16, 1e-9) * random.direction();
  axis.trocar = as_vertex(aim + random.scale(1e-3, 1.0) * random.direction());
  if (kind == 4) axis.trocar = face[0] + (face[1] - face[0]) * 0.25 + (face[2] - face[0]) * 0.5;
  const double beyond = random.chance(0.2) ? 1.0 : std::ldexp(1.0, random.integer(0, 4));
  axis.tip = axis.trocar + beyond * (aim - axis.trocar);
  if (random.chance(0.5)) std::swap(axis.trocar, axis.tip);
  return trial;
}

}  // namespace organ_collision
