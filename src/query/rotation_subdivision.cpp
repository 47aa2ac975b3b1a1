#include "rotation_subdivision.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/tool/rigid_motion.hpp"

namespace organ_collision {
namespace {

/// The cosine of the angle of the rotation R between two poses: (trace(R) - 1) / 2.
double rotation_cosine(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  return 0.5 * (from.linear().cwiseProduct(to.linear()).sum() - 1.0);
}

/// The number of equal parts that a leg must be divided into.
int count_parts(const ToolWaypoint& from, const ToolWaypoint& to) {
  double least_cosine = 1.0;
  for (std::size_t i = 0; i < to.links.size(); ++i) {
    least_cosine = std::min(least_cosine, rotation_cosine(from.links[i], to.links[i]));
  }
  if (least_cosine >= std::cos(kMaxRotation)) return 1;
  return static_cast<int>(std::ceil(std::acos(std::max(least_cosine, -1.0)) / kMaxRotation));
}

ToolWaypoint interpolated(const ToolWaypoint& from, const ToolWaypoint& to, double time) {
  ToolWaypoint waypoint{from.fraction + time * (to.fraction - from.fraction),
                        ShaftMotion{from.axis, to.axis}.at(time)};
  for (std::size_t i = 0; i < to.links.size(); ++i) {
    waypoint.links.push_back(RigidMotion(from.links[i], to.links[i]).at(time));
  }
  return waypoint;
}

}  // namespace

const ToolPath& with_subdivided_rotations(const ToolPath& path, ToolPath& finer) {
  const auto is_too_far = [](const ToolWaypoint& from, const ToolWaypoint& to) {
    return count_parts(from, to) > 1;
  };
  if (std::adjacent_find(path.begin(), path.end(), is_too_far) == path.end()) return path;
  finer = {path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const ToolWaypoint &from = path[i - 1], &to = path[i];
    const int parts = count_parts(from, to);
    for (int part = 1; part < parts; ++part) {
      finer.push_back(interpolated(from, to, static_cast<double>(part) / parts));
    }
    finer.push_back(to);
  }
  return finer;
}

}  // namespace organ_collision
