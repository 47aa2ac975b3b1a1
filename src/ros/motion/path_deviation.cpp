#include "path_deviation.hpp"

#include <algorithm>
#include <cmath>

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

StraightWay::StraightWay(const ToolWaypoint& from, const ToolWaypoint& to)
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

Deviation PathDeviation::operator()(const ToolWaypoint& waypoint, const StraightWay& way) const {
  const double time = (waypoint.fraction - way.begin) / way.duration;
  Deviation deviation{distance(way.axis.at(time), waypoint.axis), 0.0};
  for (std::size_t i = 0; i < reaches_.size(); ++i) {
    deviation.links =
        std::max(deviation.links, distance(way.links[i].at(time), waypoint.links[i], reaches_[i]));
  }
  return deviation;
}

}  // namespace organ_collision
