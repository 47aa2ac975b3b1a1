#include "contact_finder.hpp"

#include <algorithm>
#include <tuple>

#include "geometry/distance/separating_plane.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "request_check.hpp"

namespace organ_collision {
namespace {

/// Sorts the contacts by face, then link, and keeps one contact for each face and link: the first
/// touch, and of several touches at that time the deepest one. Parts of a link that pierce a face
/// have the same depth. The coordinates of the point then decide, so that the answer does not
/// depend on the order of the parts.
void keep_first_touches(std::vector<FaceContact>& contacts) {
  const auto precedes = [](const FaceContact& a, const FaceContact& b) {
    return std::tie(a.face, a.link, a.fraction, b.depth, a.point.x(), a.point.y(), a.point.z()) <
           std::tie(b.face, b.link, b.fraction, a.depth, b.point.x(), b.point.y(), b.point.z());
  };
  // If a shaft has moved on one leg, for example, its contacts are in order already.
  if (!std::is_sorted(contacts.begin(), contacts.end(), precedes)) {
    std::sort(contacts.begin(), contacts.end(), precedes);
  }
  const auto end = std::unique(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
    return a.face == b.face && a.link == b.link;
  });
  contacts.erase(end, contacts.end());
}

}  // namespace

/// The whole method, for one part of the tool. If the tool moved straight from its last pose to the
/// present one, as in the paper, the span has one leg.
void ContactFinder::find_part_contacts(const Step& step, const LegSpan& span, const ToolPart& part,
                                       std::vector<FaceContact>& contacts) {
  // Section 4 of the paper, figures 7 and 8: the space that the part sweeps. The picker builds a
  // viewing volume around it, as large as the drawn faces require (doc/theory/geometry.md,
  // Conservative wedge). The paper's volume misses parts of the space; the picker's volume contains
  // all of it, on each leg of the span.
  const PartOnLeg moving(step, span, part);
  const PartSweep swept = moving->sweep(span.deviation);

  // Section 2 of the paper: OpenGL draws the organ in a picking mode. The candidates are the faces
  // that survive clipping to the volume. Faces that need no drawing, for example because a corner
  // is inside, are candidates, too.
  picker_.pick(swept, step.organ_motion(span), candidates_);

  // Not in the paper: exact distances decide which candidates the part touches, and when and where
  // it first touches each of them.
  confirm(step, span, part, *moving, contacts);
}

void ContactFinder::find(const Step& step, std::vector<FaceContact>& contacts) {
  budget_ = WorkBudget();
  forget_touched_faces();
  touched_leg_.resize(step.organ().face_count());
  link_ = kShaft;
  for_each_part(step, [&](const ToolPart& part, const LegSpan& span) {
    find_part_contacts(step, span, part, contacts);
  });
  keep_first_touches(contacts);
  set_touching(step, contacts);
}

void ContactFinder::find_in_paper_volume(const CollisionRequest& request, CollisionResult& result) {
  const ViewingVolume volume = paper_volume(request);
  picker_.pick(volume, *request.organ, candidates_);
  for (const Candidate& candidate : candidates_) {
    result.contacts.emplace_back().face = candidate.face;
    result.view_ranges.push_back({candidate.view_min, candidate.view_max});
  }
  // Section 3 of the paper: the feedback mode gives the coordinates of the intersection.
  if (request.regions) {
    picker_.find_regions(volume, *request.organ, candidates_, result.regions);
  }
}

/// Confirms the candidates leg by leg. For each face and link, only the first leg counts on which a
/// part of the link touches the face. `on_chord`: the part along the chord of the span.
void ContactFinder::confirm(const Step& step, const LegSpan& span, const ToolPart& part,
                            const MovingPart& on_chord, std::vector<FaceContact>& contacts) {
  if (part.link != link_) forget_touched_faces();
  link_ = part.link;
  // The budget grows with the number of all faces, so that it does not depend on the picker.
  budget_.add_pairs(span.leg_count() * step.organ().face_count() * on_chord.convex_count());
  pending_faces_.clear();
  for (const Candidate& candidate : candidates_) {
    if (is_pending(candidate.face, span.begin)) {
      pending_faces_.push_back({candidate.face, span.begin});
    }
  }
  if (span.leg_count() == 1) return confirm_on_leg(step, span.begin, on_chord, contacts);
  for (std::size_t leg = span.begin; leg < span.end && !pending_faces_.empty(); ++leg) {
    const auto is_due = [leg](const PendingFace& pending) { return pending.leg <= leg; };
    if (std::any_of(pending_faces_.begin(), pending_faces_.end(), is_due)) {
      confirm_on_leg(step, leg, *PartOnLeg(step, step.span_of(leg), part), contacts);
    }
    const auto is_decided = [&](const PendingFace& pending) {
      return !is_pending(pending.face, leg + 1);
    };
    pending_faces_.erase(std::remove_if(pending_faces_.begin(), pending_faces_.end(), is_decided),
                         pending_faces_.end());
    // Most faces of a lasting contact touch on the first leg already. Only the other faces are
    // tested against the chord, because this test takes time.
    if (leg == span.begin) keep_faces_near_chord(step, span, on_chord);
  }
}

/// Drops the pending faces that stay too far from the span's chord to be touched on any leg of the
/// span. For each of the other faces, finds the first leg on which it may be touched. See
/// doc/theory/geometry.md, Spans of legs.
void ContactFinder::keep_faces_near_chord(const Step& step, const LegSpan& span,
                                          const MovingPart& on_chord) {
  const OrganMotion organ = step.organ_motion(span);
  touches_.clear();
  for (const PendingFace& pending : pending_faces_) {
    touches_.push_back({pending.face, organ.face(step.organ().faces()[pending.face]), {}});
  }
  on_chord.find_touches(on_chord.radius() + span.deviation + tolerance::kTouch, budget_,
                        surface_touches_, touches_);
  pending_faces_.clear();
  for (const FaceTouch& touch : touches_) {
    if (!touch.first) continue;
    pending_faces_.push_back({touch.face, step.leg_at(span, touch.first->time),
                              on_chord.separating_normal(touch.first->closest)});
  }
}

/// Decides by exact distances which pending faces the part touches on a leg.
void ContactFinder::confirm_on_leg(const Step& step, std::size_t leg, const MovingPart& on_leg,
                                   std::vector<FaceContact>& contacts) {
  const OrganMotion organ = step.organ_motion(step.span_of(leg));
  touches_.clear();
  for (const PendingFace& pending : pending_faces_) {
    if (pending.leg > leg) continue;
    const FaceMotion face = organ.face(step.organ().faces()[pending.face]);
    // If the tool only trembles, the plane across `normal` separates part and face on most legs.
    const double beyond = on_leg.radius() + tolerance::kTouch;
    if (!pending.normal.isZero(0.0) &&
        FixedPlane(pending.normal, on_leg.core()).keeps_beyond(face, beyond)) {
      continue;
    }
    touches_.push_back({pending.face, face, {}});
  }
  on_leg.find_touches(on_leg.radius(), budget_, surface_touches_, touches_);
  for (const FaceTouch& touch : touches_) {
    if (!touch.first) continue;
    contacts.push_back(contact_on(step, leg, on_leg, touch.face, *touch.first));
    touched_faces_.push_back(touch.face);
    touched_leg_[touch.face] = static_cast<std::uint32_t>(leg + 1);
  }
}

/// Decides by exact distances which contacts still touch when the step ends.
void ContactFinder::set_touching(const Step& step, std::vector<FaceContact>& contacts) {
  if (step.is_at_rest()) {  // What it touches, it touches at the end, too.
    for (FaceContact& contact : contacts) contact.touching = true;
    return;
  }
  const Step end = step.at_end();
  for_each_part(end, [&](const ToolPart& part, const LegSpan& span) {
    const auto is_open = [&](const FaceContact& contact) {
      return contact.link == part.link && !contact.touching;
    };
    const OrganMotion organ = end.organ_motion(span);
    touches_.clear();
    for (const FaceContact& contact : contacts) {
      if (is_open(contact)) touches_.push_back({contact.face, organ.face(contact.vertices), {}});
    }
    if (touches_.empty()) return;
    const PartOnLeg moving(end, span, part);
    budget_.add_pairs(touches_.size() * moving->convex_count());
    moving->find_touches(moving->radius(), budget_, surface_touches_, touches_);
    auto touch = touches_.begin();
    for (FaceContact& contact : contacts) {
      if (is_open(contact)) contact.touching = (touch++)->first.has_value();
    }
  });
}

/// Whether the present link may touch the face on the leg `leg` earlier than known. If one part of
/// the link is known to touch it on a later leg, another part may touch it before.
bool ContactFinder::is_pending(std::uint32_t face, std::size_t leg) const {
  return touched_leg_[face] == 0 || touched_leg_[face] > leg;
}

void ContactFinder::forget_touched_faces() {
  for (const std::uint32_t face : touched_faces_) touched_leg_[face] = 0;
  touched_faces_.clear();
}

}  // namespace organ_collision
