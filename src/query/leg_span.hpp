#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

/// [rad] The largest rotation of a link within one leg. An arc of 0.2 rad deviates from its chord
/// by half a percent of its radius.
inline constexpr double kMaxRotation = 0.2;

/// Adds waypoints to a path, without changing the motion, so that no link rotates by more than
/// kMaxRotation within a leg. With larger rotations, the boxes around the moving link would be much
/// larger than the link. Returns `path` if no waypoint is needed. Otherwise fills and returns
/// `finer`.
const ToolPath& with_subdivided_rotations(const ToolPath& path, ToolPath& finer);

/// Consecutive legs of a step, [begin, end), on which a part of the tool stays near the chord: the
/// direct motion from the first waypoint of the span to the last one. One viewing volume around the
/// chord serves all legs of the span. See doc/geometry.md, Spans of legs.
struct LegSpan {
  std::size_t begin, end;
  double deviation;  ///< [m] how far any point of the part may be from its place on the chord

  std::size_t leg_count() const { return end - begin; }
};

/// A ball around the parts of a link without their radii, in the link's frame [m].
struct LinkBall {
  Eigen::Vector3d center;
  double radius;
};

/// The ball of a link, around the boxes of all of its parts.
LinkBall ball_around(const Link& link);

/// [m] How far a link, or a shaft, may deviate from its chord: a share of the thickness of its
/// thinnest part. With a larger deviation, the volume around the chord would be much larger than
/// the volumes around the legs.
double allowed_deviation(const Link& link);
double allowed_deviation(double shaft_radius);

/// A span that begins with the leg from waypoint `begin`, not always the longest possible one. Its
/// deviation is at most `allowed` [m]. A span of one leg has the deviation 0. `count` is the number
/// of waypoints. A tool at rest has one waypoint, which counts as one leg.
LegSpan shaft_span(const ToolWaypoint* waypoints, std::size_t count, std::size_t begin,
                   double allowed);
LegSpan link_span(const ToolWaypoint* waypoints, std::size_t count, std::size_t begin,
                  std::size_t link, const LinkBall& ball, double allowed);

}  // namespace organ_collision
