#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "random_motions.hpp"

namespace organ_collision {

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
