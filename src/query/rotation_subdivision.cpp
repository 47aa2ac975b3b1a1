#include "rotation_subdivision.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/tool/rigid_motion.hpp"

namespace organ_collision {
namespace {

/// The cosine of the angle that turns one pose into the other: half of the trace less one.
double cosine(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  return 0.5 * (from.linear().cwiseProduct(to.linear()).sum() - 1.0);
}

/// Into how many equal parts a leg is to be divided.
int count_parts(const ToolWaypoint& from, const ToolWaypoint& to) {
  double least = 1.0;
  for (std::size_t i = 0; i < to.links.size(); ++i) {
    least = std::min(least, cosine(from.links[i], to.links[i]));
  }
  if (least >= std::cos(kMaxRotation)) return 1;
  return static_cast<int>(std::ceil(std::acos(std::max(least, -1.0)) / kMaxRotation));
}

ToolWaypoint between(const ToolWaypoint& from, const ToolWaypoint& to, double time) {
  ToolWaypoint waypoint{from.fraction + time * (to.fraction - from.fraction),
                        ShaftMotion{from.axis, to.axis}.at(time)};
  for (std::size_t i = 0; i < to.links.size(); ++i) {
    waypoint.links.push_back(RigidMotion(from.links[i], to.links[i]).at(time));
  }
  return waypoint;
}

}  // namespace

const ToolPath& with_subdivided_rotations(const ToolPath& path, ToolPath& finer) {
  const auto turns_far = [](const ToolWaypoint& from, const ToolWaypoint& to) {
    return count_parts(from, to) > 1;
  };
  if (std::adjacent_find(path.begin(), path.end(), turns_far) == path.end()) return path;
  finer = {path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const ToolWaypoint &from = path[i - 1], &to = path[i];
    const int parts = count_parts(from, to);
    for (int part = 1; part < parts; ++part) {
      finer.push_back(between(from, to, static_cast<double>(part) / parts));
    }
    finer.push_back(to);
  }
  return finer;
}

}  // namespace organ_collision
