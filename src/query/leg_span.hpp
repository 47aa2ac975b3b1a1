#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

/// Consecutive legs of a step, [begin, end), on which a part of the tool stays near its chord: the
/// motion straight from the first waypoint to the last. One viewing volume around the chord serves
/// them all.
struct LegSpan {
  std::size_t begin, end;
  double deviation;  ///< [m] no point of the part is farther than this from its place on the chord

  std::size_t leg_count() const { return end - begin; }
};

/// A ball that holds a link, in the link's frame [m].
struct LinkBall {
  Eigen::Vector3d center;
  double radius;
};

/// Around the cores of all parts of a link; their own radii left aside.
LinkBall ball_around(const Link& link);

/// [m] How far from its chord a link may stray before a volume around the chord becomes much larger
/// than those around the legs: a share of the thickness of its thinnest part.
double allowed_deviation(const Link& link);
/// The same of a shaft.
double allowed_deviation(double shaft_radius);

/// The longest span found that begins with the leg from waypoint `begin` and deviates by no more
/// than is allowed; at least that one leg, which deviates by nothing. `waypoints` as many as
/// `count`; of a tool at rest there is one, which is one leg.
LegSpan shaft_span(const ToolWaypoint* waypoints, std::size_t count, std::size_t begin,
                   double allowed);
LegSpan link_span(const ToolWaypoint* waypoints, std::size_t count, std::size_t begin,
                  std::size_t link, const LinkBall& ball, double allowed);

}  // namespace organ_collision
