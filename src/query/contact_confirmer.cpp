#include "contact_confirmer.hpp"

#include <algorithm>

#include "geometry/distance/separating_plane.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {

void ContactConfirmer::start(const Step& step) {
  budget_ = WorkBudget();
  forget_touched_faces();
  touched_leg_.resize(step.organ().face_count());
  link_ = 0;
}

void ContactConfirmer::confirm(const Step& step, const LegSpan& span, const ToolPart& part,
                               const std::vector<Candidate>& candidates,
                               std::vector<FaceContact>& contacts) {
  if (part.number(step) != link_) forget_touched_faces();
  link_ = part.number(step);
  budget_.add_pairs(span.leg_count() * step.organ().face_count() * part.convex_count());
  pending_faces_.clear();
  for (const Candidate& candidate : candidates) {
    if (is_pending(candidate.face, span.begin)) {
      pending_faces_.push_back({candidate.face, span.begin});
    }
  }
  for (std::size_t leg = span.begin; leg < span.end && !pending_faces_.empty(); ++leg) {
    confirm_on_leg(step, leg, part, contacts);
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

/// Drops the faces that stay too far from the part's motion along the span's chord to touch on any
/// of the span's legs. Finds for each of the others the first leg on which it may touch. See
/// doc/geometry.md, Spans of legs.
void ContactConfirmer::keep_faces_near_chord(const Step& step, const LegSpan& span,
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
void ContactConfirmer::confirm_on_leg(const Step& step, std::size_t leg, const ToolPart& part,
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
      touched_faces_.push_back(touch.face);
      touched_leg_[touch.face] = static_cast<std::uint32_t>(leg + 1);
    }
  });
}

/// Finds for each of `touches_` when it first comes within `radius` of the part.
void ContactConfirmer::find_touches(const PartLeg& part, const LinkPart* shape, double radius) {
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
bool ContactConfirmer::is_pending(std::uint32_t face, std::size_t leg) const {
  return touched_leg_[face] == 0 || touched_leg_[face] > leg;
}

void ContactConfirmer::forget_touched_faces() {
  for (const std::uint32_t face : touched_faces_) touched_leg_[face] = 0;
  touched_faces_.clear();
}

}  // namespace organ_collision
