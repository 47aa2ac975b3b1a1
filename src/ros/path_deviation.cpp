#include "organ_collision/ros/path_deviation.hpp"

#include <algorithm>
#include <cmath>

#include "organ_collision/geometry/rigid_motion.hpp"

namespace organ_collision {
namespace {

/// [m] The farthest that any point of the link lies from its origin, or farther.
double reach(const Link& link) {
  double farthest = 0.0;
  for (const LinkPart& part : link.parts) {
    const OrientedBox& box = part.bounds;
    const Eigen::Vector3d center = box.axes.transpose() * box.center;
    farthest = std::max(farthest, (center.cwiseAbs() + box.half_size).norm() + part.radius);
  }
  return farthest;
}

/// [m] How far two axes are apart, end by end.
double distance(const ShaftAxis& a, const ShaftAxis& b) {
  return std::max((a.trocar - b.trocar).norm(), (a.tip - b.tip).norm());
}

/// [m] How far any point within `reach` of the origin is from where it would be in another pose, or
/// farther. Turning by an angle moves it by 2 reach sin(angle / 2), and the turns' matrices differ
/// by sqrt(8) sin(angle / 2).
double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double reach) {
  return (a.translation() - b.translation()).norm() +
         reach * std::sqrt(0.5) * (a.linear() - b.linear()).norm();
}

}  // namespace

PathDeviation::PathDeviation(const std::vector<Link>& links) {
  reaches_.reserve(links.size());
  for (const Link& link : links) reaches_.push_back(reach(link));
}

Deviation PathDeviation::operator()(const ToolWaypoint& a, const ToolWaypoint& b,
                                    const ToolWaypoint& c) const {
  const double time = (b.fraction - a.fraction) / (c.fraction - a.fraction);
  Deviation deviation{distance(ShaftMotion{a.axis, c.axis}.at(time), b.axis), 0.0};
  for (std::size_t i = 0; i < reaches_.size(); ++i) {
    const Eigen::Isometry3d straight = RigidMotion(a.links[i], c.links[i]).at(time);
    deviation.links = std::max(deviation.links, distance(straight, b.links[i], reaches_[i]));
  }
  return deviation;
}

}  // namespace organ_collision
