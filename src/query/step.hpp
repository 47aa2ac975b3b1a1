#pragma once

#include <cstddef>
#include <cstdint>

#include "contact_refiner.hpp"
#include "geometry/organ/organ_motion.hpp"
#include "leg_span.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// A request's step, leg by leg: the tool between two waypoints, the faces in that share of the
/// step. A view of request and path, which must outlive it.
class Step {
 public:
  /// `boxes` are refitted where the organ's shapes do not share their clusters.
  Step(const CollisionRequest& request, const ToolPath& path, BlockBoxes& boxes);

  const TriangleMesh& organ() const { return organ_; }
  bool has_shaft() const { return radius_ > 0.0; }
  double radius() const { return radius_; }  ///< [m] of the shaft
  std::size_t link_count() const { return links_ ? links_->size() : 0; }
  const Link& link(std::size_t link) const { return (*links_)[link]; }
  /// As in FaceContact.
  std::uint32_t number(std::size_t link) const {
    return static_cast<std::uint32_t>(has_shaft() ? link + 1 : link);
  }

  /// A tool at rest has one leg without motion.
  std::size_t leg_count() const { return waypoint_count_ > 1 ? waypoint_count_ - 1 : 1; }
  /// The leg that a fraction of the step falls in; the earlier one at a waypoint.
  std::size_t leg_at(double fraction) const;

  LegSpan span_of(std::size_t leg) const { return {leg, leg + 1, 0.0}; }
  /// The longest spans found that begin with a leg.
  LegSpan shaft_span(std::size_t leg) const;
  LegSpan link_span(std::size_t leg, std::size_t link, const LinkBall& ball) const;

  /// What moves how on a leg, or along the chord of a span.
  ShaftMotion shaft(std::size_t leg) const { return shaft(span_of(leg)); }
  ShaftMotion shaft(const LegSpan& span) const { return {from(span).axis, to(span).axis}; }
  RigidMotion link_motion(std::size_t leg, std::size_t link) const {
    return link_motion(span_of(leg), link);
  }
  RigidMotion link_motion(const LegSpan& span, std::size_t link) const {
    return {from(span).links[link], to(span).links[link]};
  }
  OrganMotion organ_motion(const LegSpan& span) const;
  FaceLeg face(std::size_t leg, std::uint32_t face) const;
  /// The leg of a span in which a time of its chord falls; the earlier one at a waypoint.
  std::size_t leg_at(const LegSpan& span, double time) const;
  /// Where shaft and links are when the step ends.
  PartEnd shaft_end() const { return {last().axis}; }
  PartEnd link_end(std::size_t link) const { return {{}, &(*links_)[link], last().links[link]}; }

 private:
  const ToolWaypoint& last() const { return waypoints_[waypoint_count_ - 1]; }
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
  const BlockBoxes* boxes_before_ = nullptr;  ///< of the organ before, in its present clusters
};

}  // namespace organ_collision
