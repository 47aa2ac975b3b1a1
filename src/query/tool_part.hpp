#pragma once

#include <cstddef>
#include <cstdint>

#include "contact_refiner.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "step.hpp"

namespace organ_collision {

/// The shaft of a tool, or a part of one of its links.
struct ToolPart {
  const LinkPart* shape = nullptr;  ///< null: the shaft
  std::size_t link = 0;

  bool is_surface() const { return shape && shape->surface; }
  /// The number of the shaft or of the link, as in FaceContact::link.
  std::uint32_t number(const Step& step) const { return shape ? step.link_number(link) : 0; }
  /// [m] The radius of a shaft or a ball; 0 for other shapes. See ToolClearance.
  double surface_radius(const Step& step) const {
    return shape ? shape->ball_radius() : step.radius();
  }
  /// A surface counts as one convex part for each of its triangles.
  std::size_t convex_count() const { return is_surface() ? shape->surface->faces().size() : 1; }
};

/// Calls use(part_leg) with a part that moves along the chord of a span. The part leg refers to a
/// motion that lives only during the call.
template <typename Use>
void with_part_leg(const Step& step, const LegSpan& span, const ToolPart& part, Use use) {
  if (!part.shape) return use(PartLeg{step.shaft_motion(span), step.radius(), step.shaft_end(), 0});
  const RigidMotion motion = step.link_motion(span, part.link);
  use(PartLeg{{part.shape->core, motion},
              part.shape->radius,
              step.link_end(part.link),
              step.link_number(part.link)});
}

/// Calls use(part, span) for each part of a tool and each span of legs on which it stays near its
/// chord. Goes from link to link, then from span to span.
template <typename Use>
void for_each_part(const Step& step, Use use) {
  for (std::size_t leg = 0; step.has_shaft() && leg < step.leg_count();) {
    const LegSpan span = step.shaft_span(leg);
    use(ToolPart{}, span);
    leg = span.end;
  }
  for (std::size_t link = 0; link < step.link_count(); ++link) {
    const LinkBall ball = ball_around(step.link(link));
    for (std::size_t leg = 0; leg < step.leg_count();) {
      const LegSpan span = step.link_span(leg, link, ball);
      for (const LinkPart& part : step.link(link).parts) use(ToolPart{&part, link}, span);
      leg = span.end;
    }
  }
}

}  // namespace organ_collision
