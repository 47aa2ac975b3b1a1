#include "path_deviation.hpp"

#include <algorithm>
#include <cmath>

namespace organ_collision {
namespace {

/// [m] An upper bound for the distance of the link's points from its origin.
double reach(const Link& link) {
  double farthest = 0.0;
  for (const LinkPart& part : link.parts) {
    const OrientedBox& box = part.bounds;
    const Eigen::Vector3d center = box.axes.transpose() * box.center;
    farthest = std::max(farthest, (center.cwiseAbs() + box.half_size).norm() + part.radius);
  }
  return farthest;
}

/// [m] The larger of the distances between corresponding ends of two axes.
double distance(const ShaftAxis& a, const ShaftAxis& b) {
  return std::max((a.trocar - b.trocar).norm(), (a.tip - b.tip).norm());
}

/// [m] An upper bound for the distance between the positions of a point in two poses, for all
/// points within `reach` of the origin. A rotation by an angle moves such a point by at most
/// 2 reach sin(angle / 2). The Frobenius norm of the difference of the rotation matrices is
/// sqrt(8) sin(angle / 2).
double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double reach) {
  return (a.translation() - b.translation()).norm() +
         reach * std::sqrt(0.5) * (a.linear() - b.linear()).norm();
}

}  // namespace

StraightMotion::StraightMotion(const ToolWaypoint& from, const ToolWaypoint& to)
    : begin(from.fraction), duration(to.fraction - from.fraction), axis{from.axis, to.axis} {
  links.reserve(from.links.size());
  for (std::size_t i = 0; i < from.links.size(); ++i) {
    links.emplace_back(from.links[i], to.links[i]);
  }
}

PathDeviation::PathDeviation(const std::vector<Link>& links) {
  reaches_.reserve(links.size());
  for (const Link& link : links) reaches_.push_back(reach(link));
}

Deviation PathDeviation::operator()(const ToolWaypoint& waypoint,
                                    const StraightMotion& motion) const {
  const double time = (waypoint.fraction - motion.begin) / motion.duration;
  Deviation deviation{distance(motion.axis.at(time), waypoint.axis), 0.0};
  for (std::size_t i = 0; i < reaches_.size(); ++i) {
    deviation.links = std::max(deviation.links,
                               distance(motion.links[i].at(time), waypoint.links[i], reaches_[i]));
  }
  return deviation;
}

}  // namespace organ_collision
