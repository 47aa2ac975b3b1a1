#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "geometry/organ/organ_motion.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// [rad] The largest rotation of a link, or of what carries an end of a shaft, within one leg. An
/// arc of 0.2 rad deviates from its chord by half a percent of its radius.
inline constexpr double kMaxRotation = 0.2;

/// Adds waypoints to a path, without changing the motion, so that nothing rotates by more than
/// kMaxRotation within a leg. With larger rotations, the volumes around the moving link or shaft
/// would be much larger than the link or shaft. Returns `path` if no waypoint is needed. Otherwise
/// fills and returns `finer`.
const ToolPath& with_subdivided_rotations(const ToolPath& path, ToolPath& finer);

/// Consecutive legs of a step, [begin, end), on which a part of the tool stays near the chord: the
/// direct motion from the first waypoint of the span to the last one. One viewing volume around the
/// chord serves all legs of the span. See doc/theory/geometry.md, Spans of legs.
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

/// A span that begins with the leg from waypoint `begin`, not always the longest possible one. Its
/// deviation is at most `allowed` [m]. A span of one leg has the deviation 0. `count` is the number
/// of waypoints. A tool at rest has one waypoint, which counts as one leg.
LegSpan shaft_span(const ToolWaypoint* waypoints, std::size_t count, std::size_t begin,
                   double allowed);
LegSpan link_span(const ToolWaypoint* waypoints, std::size_t count, std::size_t begin,
                  std::size_t link, const LinkBall& ball, double allowed);

/// The step of a request, leg by leg. A leg is the motion of the tool from one waypoint of the path
/// to the next, and the motion of the organ meanwhile. The step refers to the request and the path,
/// which must outlive the step.
class Step {
 public:
  /// `path` is the request's path, or a subdivision of it. `boxes` is memory for the boxes of the
  /// organ's earlier shape, and must outlive the step. It is used if both shapes do not share
  /// clusters.
  Step(const CollisionRequest& request, const ToolPath& path, BlockBoxes& boxes);

  // Steps in which the organ rests. The first two have no motion either.
  Step at_end() const { return {organ_, *this, last(), 1}; }
  Step at_start() const {
    return {organ_before_ ? *organ_before_ : organ_, *this, waypoints_[0], 1};
  }
  /// The tool's motion on one leg.
  Step on_leg(std::size_t leg) const {
    return {organ_, *this, waypoints_[leg], std::min<std::size_t>(waypoint_count_, 2)};
  }

  /// Whether neither the tool nor the organ moves.
  bool is_at_rest() const { return waypoint_count_ == 1 && !organ_before_; }

  const TriangleMesh& organ() const { return organ_; }
  bool has_shaft() const { return radius_ > 0.0; }
  double radius() const { return radius_; }  ///< [m] radius of the shaft
  std::size_t link_count() const { return links_ ? links_->size() : 0; }
  const Link& link(std::size_t link) const { return (*links_)[link]; }

  /// The number of legs. A tool at rest has one leg, without motion.
  std::size_t leg_count() const { return waypoint_count_ > 1 ? waypoint_count_ - 1 : 1; }
  /// The fraction of the step at the time `time` of a leg, in [0, 1].
  double fraction_at(std::size_t leg, double time) const {
    return begin(span_of(leg)) + time * (finish(span_of(leg)) - begin(span_of(leg)));
  }
  /// The leg at a fraction of the step. At a waypoint, it is the leg that ends there.
  std::size_t leg_at(double fraction) const;

  /// The span that consists of a single leg.
  LegSpan span_of(std::size_t leg) const { return {leg, leg + 1, 0.0}; }
  /// A span of the shaft or of a link that begins with the leg `leg`.
  LegSpan shaft_span(std::size_t leg) const;
  LegSpan link_span(std::size_t leg, std::size_t link, const LinkBall& ball) const;

  /// The motion of the shaft or of a link along the chord of a span. If the span has one leg, it
  /// is the motion on this leg, as its joints have it.
  ShaftMotion shaft_motion(const LegSpan& span) const {
    ShaftMotion motion{from(span).axis, to(span).axis};
    if (waypoint_count_ > 1 && span.leg_count() == 1) motion.arcs = to(span).arcs;
    return motion;
  }
  RigidMotion link_motion(const LegSpan& span, std::size_t link) const {
    const ToolWaypoint& end = to(span);
    const bool on_joints = waypoint_count_ > 1 && span.leg_count() == 1 && !end.joints.empty();
    return {from(span).links[link], end.links[link], on_joints ? end.joints[link] : ChainMotion{}};
  }
  /// The motion of the organ during a span.
  OrganMotion organ_motion(const LegSpan& span) const;
  /// The leg of a span at the time `time` of the chord, in [0, 1]. At a waypoint, it is the leg
  /// that ends there.
  std::size_t leg_at(const LegSpan& span, double time) const;
  /// The pose of the tool at the end of the step.
  const ToolWaypoint& last() const { return waypoints_[waypoint_count_ - 1]; }

 private:
  Step(const TriangleMesh& organ, const Step& step, const ToolWaypoint& first, std::size_t count)
      : organ_(organ),
        organ_before_(nullptr),
        radius_(step.radius_),
        links_(step.links_),
        waypoints_(&first),
        waypoint_count_(count) {}

  const ToolWaypoint& from(const LegSpan& span) const { return waypoints_[span.begin]; }
  const ToolWaypoint& to(const LegSpan& span) const {
    return waypoints_[waypoint_count_ > 1 ? span.end : 0];
  }
  double begin(const LegSpan& span) const {
    return waypoint_count_ > 1 ? from(span).fraction : 0.0;
  }
  double finish(const LegSpan& span) const { return waypoint_count_ > 1 ? to(span).fraction : 1.0; }

  const TriangleMesh& organ_;
  const TriangleMesh* organ_before_;
  double radius_;
  const std::vector<Link>* links_;
  const ToolWaypoint* waypoints_;
  std::size_t waypoint_count_;
  /// The boxes of the earlier shape for the clusters of the later one; null if the organ rests.
  const BlockBoxes* boxes_before_ = nullptr;
};

/// The velocity [m/s] of the tissue at a point of a face, as CollisionRequest::velocity_from says.
Eigen::Vector3d tissue_velocity(const CollisionRequest& request, std::uint32_t face,
                                const Eigen::Vector3d& barycentric);

}  // namespace organ_collision
