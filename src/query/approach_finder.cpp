#include "approach_finder.hpp"

#include <optional>

#include "geometry/distance/shaft_box.hpp"
#include "geometry/distance/swept_box.hpp"

namespace organ_collision {
namespace {

/// A box around the space that a part's core covers along the chord of a span.
OrientedBox box_around(const Step& step, const LegSpan& span, const ToolPart& part) {
  if (!part.shape) return box_around(step.shaft_motion(span));
  return SweptBox(part.shape->bounds, step.link_motion(span, part.link), 0.0).bounds();
}

/// The closest approach of a part and a face, unless the budget is used up. Tells the sink if it
/// may be missing or too far.
std::optional<ClosestApproach> measured(const ToolPart& part, const PartLeg& leg,
                                        const OrganMotion& organ, std::uint32_t face,
                                        double distance_bound, WorkBudget& budget,
                                        ApproachSink& sink) {
  const FaceMotion motion = organ.face(organ.after().faces()[face]);
  const std::uint64_t cuts = budget.cuts();
  std::optional<ClosestApproach> approach;
  if (budget.is_used_up()) {
    budget.add_cut();
  } else if (part.is_surface()) {
    approach =
        closest_approach(*part.shape->surface, *leg.core.link(), motion, distance_bound, budget);
  } else {
    approach = closest_approach(leg.core, motion, distance_bound, budget);
  }
  if (budget.cuts() != cuts) sink.add_unresolved(face);
  return approach;
}

}  // namespace

void ApproachFinder::find(const Step& step, WorkBudget& budget, ApproachSink& sink) {
  for_each_part(step, [&](const ToolPart& part, const LegSpan& span) {
    budget.add_pairs(span.leg_count() * step.organ().face_count() * part.convex_count());
    find_near_chord(step, span, part, budget, sink);
    for (std::size_t leg = span.begin; leg < span.end && !faces_.empty(); ++leg) {
      find_on_leg(step, leg, part, budget, sink);
    }
  });
}

/// Measures the faces along the chord of a span. If the span has a single leg, which is its chord,
/// these are the approaches. Else the faces that come near the chord are kept for its legs.
void ApproachFinder::find_near_chord(const Step& step, const LegSpan& span, const ToolPart& part,
                                     WorkBudget& budget, ApproachSink& sink) {
  const OrganMotion organ = step.organ_motion(span);
  const double radius = part.surface_radius(step);
  const auto bound = [&] { return sink.bound() + radius + span.deviation; };
  faces_.clear();
  with_part_leg(step, span, part, [&](const PartLeg& on_chord) {
    search_.visit(organ, box_around(step, span, part), bound, [&](std::uint32_t face) {
      if (!sink.accepts(face)) return;
      const auto approach = measured(part, on_chord, organ, face, bound(), budget, sink);
      if (!approach) return;
      if (span.leg_count() > 1) return faces_.push_back(face);
      sink.add({approach->closest.distance - radius, face, part, span.begin, *approach});
    });
  });
}

/// Measures the faces that come near the chord on one leg.
void ApproachFinder::find_on_leg(const Step& step, std::size_t leg, const ToolPart& part,
                                 WorkBudget& budget, ApproachSink& sink) const {
  const OrganMotion organ = step.organ_motion(step.span_of(leg));
  const double radius = part.surface_radius(step);
  with_part_leg(step, step.span_of(leg), part, [&](const PartLeg& on_leg) {
    for (const std::uint32_t face : faces_) {
      if (!sink.accepts(face)) continue;
      const auto approach =
          measured(part, on_leg, organ, face, sink.bound() + radius, budget, sink);
      if (approach) {
        sink.add({approach->closest.distance - radius, face, part, leg, *approach});
      }
    }
  });
}

}  // namespace organ_collision
