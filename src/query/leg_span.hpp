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

/// The same motion with waypoints added, so that no link rotates by more than kMaxRotation within a
/// leg. Larger rotations would make the boxes around the moving link loose. Returns `path` itself
/// if no waypoint is needed. Otherwise fills and returns `finer`.
const ToolPath& with_subdivided_rotations(const ToolPath& path, ToolPath& finer);

/// Consecutive legs of a step, [begin, end), on which a part of the tool stays near its chord. The
/// chord is the motion that leads directly from the first waypoint of the span to the last. One
/// viewing volume around the chord serves all legs of the span. See doc/geometry.md, Spans of legs.
struct LegSpan {
  std::size_t begin, end;
  double deviation;  ///< [m] bound on how far any point of the part is from its place on the chord

  std::size_t leg_count() const { return end - begin; }
};

/// A ball that contains a link, in the link's frame [m].
struct LinkBall {
  Eigen::Vector3d center;
  double radius;
};

/// A ball around the cores of all parts of a link. It need not contain the parts' radii.
LinkBall ball_around(const Link& link);

/// [m] How far a link may deviate from its chord: a share of the thickness of its thinnest part.
/// With a larger deviation, the volume around the chord would be much larger than the volumes
/// around the legs.
double allowed_deviation(const Link& link);
/// The same for a shaft with its radius [m].
double allowed_deviation(double shaft_radius);

/// A long span that begins with the leg from waypoint `begin` and whose deviation is at most
/// `allowed` [m]: at least that one leg, whose deviation is 0. There are `count` waypoints. A tool
/// at rest has one waypoint, which counts as one leg.
LegSpan shaft_span(const ToolWaypoint* waypoints, std::size_t count, std::size_t begin,
                   double allowed);
LegSpan link_span(const ToolWaypoint* waypoints, std::size_t count, std::size_t begin,
                  std::size_t link, const LinkBall& ball, double allowed);

}  // namespace organ_collision
