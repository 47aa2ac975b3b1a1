#include "contact_finder.hpp"

#include <algorithm>

#include "geometry/distance/separating_plane.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
void ContactFinder::find(const Step& step, std::vector<FaceContact>& contacts) {
  budget_ = WorkBudget();
  touched_leg_.resize(step.organ().face_count());
  std::uint32_t link = 0;
  std::size_t begin = contacts.size();
  try {
    for_each_part(step, [&](const ToolPart& part, const LegSpan& span) {
      if (part.number(step) != link) {
        forget_touched_legs(contacts, begin);
        link = part.number(step);
        begin = contacts.size();
      }
      find_part_contacts(step, span, part, contacts);
    });
    forget_touched_legs(contacts, begin);
  } catch (...) {
    touched_leg_.clear();
    throw;
  }
}

/// The method, for one part of the tool. A viewing volume is built around the space that the part
/// sweeps, GL draws the organ in a picking mode, and exact distances decide on the faces that
/// survive clipping.
void ContactFinder::find_part_contacts(const Step& step, const LegSpan& span, const ToolPart& part,
                                       std::vector<FaceContact>& contacts) {
  pick(step, span, part);
  budget_.add_pairs(span.leg_count() * step.organ().face_count() * part.convex_count());
  pending_faces_.clear();
  for (const Candidate& candidate : candidates_) {
    if (is_pending(candidate.face, span.begin)) {
      pending_faces_.push_back({candidate.face, span.begin});
    }
  }
  for (std::size_t leg = span.begin; leg < span.end && !pending_faces_.empty(); ++leg) {
    find_contacts_on_leg(step, leg, part, contacts);
    const auto is_decided = [&](const PendingFace& pending) {
      return !is_pending(pending.face, leg + 1);
    };
    pending_faces_.erase(std::remove_if(pending_faces_.begin(), pending_faces_.end(), is_decided),
                         pending_faces_.end());
    // Most faces of a sustained contact touch on the first leg. Only the others are worth testing
    // against the chord.
    if (leg == span.begin && span.leg_count() > 1) keep_faces_near_chord(step, span, part);
  }
}

void ContactFinder::pick(const Step& step, const LegSpan& span, const ToolPart& part) {
  const OrganMotion organ = step.organ_motion(span);
  if (!part.shape) {
    const ShaftMotion chord = step.shaft_motion(span);
    picker_.pick(PartSweep(chord, step.radius() + span.deviation), organ, candidates_);
  } else {
    const SweptBox box(part.shape->bounds, step.link_motion(span, part.link),
                       part.shape->radius + span.deviation);
    picker_.pick(PartSweep(box), organ, candidates_);
  }
}

/// Drops the faces that stay too far from the part's motion along the span's chord to touch on any
/// of the span's legs. Finds for each of the others the first leg on which it may touch. See
/// doc/geometry.md, Spans of legs.
void ContactFinder::keep_faces_near_chord(const Step& step, const LegSpan& span,
                                          const ToolPart& part) {
  const OrganMotion organ = step.organ_motion(span);
  touches_.clear();
  for (const PendingFace& pending : pending_faces_) {
    touches_.push_back({pending.face, organ.face(step.organ().faces()[pending.face]), {}});
  }
  with_part_leg(step, span, part, [&](const PartLeg& on_chord) {
    find_touches(on_chord, part.shape, on_chord.radius + span.deviation + tolerance::kTouch);
  });
  pending_faces_.clear();
  for (const FaceTouch& touch : touches_) {
    if (!touch.first) continue;
    const ClosestPoints& closest = touch.first->closest;
    const bool is_direction = !part.is_surface() && closest.distance > tolerance::kPierced;
    pending_faces_.push_back(
        {touch.face, step.leg_at(span, touch.first->time),
         is_direction ? closest.separation.normalized() : Eigen::Vector3d::Zero()});
  }
}

/// Decides by exact distances which pending faces touch on a leg.
void ContactFinder::find_contacts_on_leg(const Step& step, std::size_t leg, const ToolPart& part,
                                         std::vector<FaceContact>& contacts) {
  const auto is_due = [leg](const PendingFace& pending) { return pending.leg <= leg; };
  if (std::none_of(pending_faces_.begin(), pending_faces_.end(), is_due)) return;
  const OrganMotion organ = step.organ_motion(step.span_of(leg));
  with_part_leg(step, step.span_of(leg), part, [&](const PartLeg& on_leg) {
    touches_.clear();
    for (const PendingFace& pending : pending_faces_) {
      if (!is_due(pending)) continue;
      const FaceMotion face = organ.face(step.organ().faces()[pending.face]);
      // If the tool only trembles, the same plane separates part and face on most legs.
      const double beyond = on_leg.radius + tolerance::kTouch;
      if (!pending.normal.isZero(0.0) && stays_beyond(pending.normal, on_leg.core, face, beyond)) {
        continue;
      }
      touches_.push_back({pending.face, face, {}});
    }
    find_touches(on_leg, part.shape, on_leg.radius);
    for (const FaceTouch& touch : touches_) {
      if (!touch.first) continue;
      contacts.push_back(contact_of(*touch.first, on_leg, step.face_leg(leg, touch.face)));
      contacts.back().face = touch.face;
      touched_leg_[touch.face] = static_cast<std::uint32_t>(leg + 1);
    }
  });
}

/// Finds for each of `touches_` when it first comes within `radius` of the part.
void ContactFinder::find_touches(const PartLeg& part, const LinkPart* shape, double radius) {
  if (touches_.empty()) return;
  if (shape && shape->surface) {
    surface_touches_.find(*shape->surface, *part.core.link(), radius, budget_, touches_);
  } else {
    for (FaceTouch& touch : touches_) {
      touch.first = first_touch(part.core, touch.motion, radius, budget_);
    }
  }
}

/// Whether the present link is not known to touch the face on a leg before `leg`.
bool ContactFinder::is_pending(std::uint32_t face, std::size_t leg) const {
  return touched_leg_[face] == 0 || touched_leg_[face] > leg;
}

/// Clears touched_leg_ for the next link. The contacts from `begin` on belong to the present one.
void ContactFinder::forget_touched_legs(const std::vector<FaceContact>& touched,
                                        std::size_t begin) {
  for (std::size_t i = begin; i < touched.size(); ++i) touched_leg_[touched[i].face] = 0;
}

}  // namespace organ_collision
