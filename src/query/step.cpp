#include "step.hpp"

#include <algorithm>

namespace organ_collision {

Step::Step(const CollisionRequest& request, const ToolPath& path, BlockBoxes& boxes)
    : organ_(*request.organ),
      organ_before_(request.mode == QueryMode::kStatic ? nullptr : request.organ_before),
      radius_(request.radius),
      links_(request.links),
      waypoints_(request.mode == QueryMode::kStatic ? &path.back() : path.data()),
      waypoint_count_(request.mode == QueryMode::kStatic ? 1 : path.size()) {
  if (!organ_before_) return;
  boxes_before_ = &organ_before_->block_boxes();
  if (&organ_before_->clusters() != &organ_.clusters()) {
    boxes.refit(organ_.clusters(), organ_before_->vertices());
    boxes_before_ = &boxes;
  }
}

LegSpan Step::shaft_span(std::size_t leg) const {
  return organ_collision::shaft_span(waypoints_, waypoint_count_, leg, allowed_deviation(radius_));
}

LegSpan Step::link_span(std::size_t leg, std::size_t link, const LinkBall& ball) const {
  return organ_collision::link_span(waypoints_, waypoint_count_, leg, link, ball,
                                    allowed_deviation((*links_)[link]));
}

std::size_t Step::leg_at(double fraction) const { return leg_at({0, leg_count(), 0.0}, fraction); }

std::size_t Step::leg_at(const LegSpan& span, double time) const {
  const double fraction = begin(span) + time * (finish(span) - begin(span));
  const ToolWaypoint* const ends = waypoints_ + 1;
  const auto next = std::lower_bound(
      ends + span.begin, ends + span.end - 1, fraction,
      [](const ToolWaypoint& waypoint, double value) { return waypoint.fraction < value; });
  return static_cast<std::size_t>(next - ends);
}

OrganMotion Step::organ_motion(const LegSpan& span) const {
  if (!organ_before_) return OrganMotion(organ_);
  return {*organ_before_, *boxes_before_, organ_, begin(span), finish(span)};
}

FaceLeg Step::face_leg(std::size_t leg, std::uint32_t face) const {
  const FaceIndices& corners = organ_.faces()[face];
  return {organ_motion(span_of(leg)).face(corners), begin(span_of(leg)), finish(span_of(leg)),
          organ_.triangle(corners)};
}

}  // namespace organ_collision
