#include "contact_finder.hpp"

#include <algorithm>

#include "geometry/distance/separating_plane.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

/// Calls use(part_leg) with a part on the chord of a span.
template <typename Use>
void with_part(const Step& step, const LegSpan& span, const LinkPart* shape, std::size_t link,
               Use use) {
  if (!shape) return use(PartLeg{step.shaft(span), step.radius(), step.shaft_end(), 0});
  const RigidMotion motion = step.link_motion(span, link);
  use(PartLeg{{shape->core, motion}, shape->radius, step.link_end(link), step.number(link)});
}

}  // namespace

void ContactFinder::find(const Step& step, std::vector<FaceContact>& contacts) {
  budget_ = {};
  touched_leg_.resize(step.organ().face_count());
  try {
    if (step.has_shaft()) touch_shaft(step, contacts);
    for (std::size_t link = 0; link < step.link_count(); ++link) touch_link(step, link, contacts);
  } catch (...) {
    touched_leg_.clear();
    throw;
  }
}

void ContactFinder::touch_shaft(const Step& step, std::vector<FaceContact>& contacts) {
  const std::size_t begin = contacts.size();
  for (std::size_t leg = 0; leg < step.leg_count();) {
    const LegSpan span = step.shaft_span(leg);
    touch_part(step, span, {}, contacts);
    leg = span.end;
  }
  open_all(contacts, begin);
}

void ContactFinder::touch_link(const Step& step, std::size_t link,
                               std::vector<FaceContact>& contacts) {
  const std::size_t begin = contacts.size();
  const LinkBall ball = ball_around(step.link(link));
  for (std::size_t leg = 0; leg < step.leg_count();) {
    const LegSpan span = step.link_span(leg, link, ball);
    for (const LinkPart& part : step.link(link).parts) {
      touch_part(step, span, {&part, link}, contacts);
    }
    leg = span.end;
  }
  open_all(contacts, begin);
}

/// The method: a camera's viewing volume is given the shape of the space that the part swept, the
/// organ is drawn in a picking mode, and exact distances decide on what survives clipping.
void ContactFinder::touch_part(const Step& step, const LegSpan& span, const Part& part,
                               std::vector<FaceContact>& contacts) {
  pick(step, span, part);
  budget_.add_pairs(span.leg_count() * step.organ().face_count() * part.convex_count());
  open_faces_.clear();
  for (const Candidate& candidate : candidates_) {
    if (is_open(candidate.face, span.begin)) open_faces_.push_back({candidate.face, span.begin});
  }
  for (std::size_t leg = span.begin; leg < span.end && !open_faces_.empty(); ++leg) {
    touch_on_leg(step, leg, part, contacts);
    const auto is_closed = [&](const OpenFace& open) { return !is_open(open.face, leg + 1); };
    open_faces_.erase(std::remove_if(open_faces_.begin(), open_faces_.end(), is_closed),
                      open_faces_.end());
    // Most faces of a sustained contact touch on the first leg and need no bound.
    if (leg == span.begin && span.leg_count() > 1) find_first_legs(step, span, part);
  }
}

void ContactFinder::pick(const Step& step, const LegSpan& span, const Part& part) {
  const OrganMotion organ = step.organ_motion(span);
  if (!part.shape) {
    const ShaftMotion chord = step.shaft(span);
    picker_.pick(PartSweep(chord, step.radius() + span.deviation), organ, candidates_);
  } else {
    const SweptBox box(part.shape->bounds, step.link_motion(span, part.link),
                       part.shape->radius + span.deviation);
    picker_.pick(PartSweep(box), organ, candidates_);
  }
}

/// Leaves open only the faces that come near enough to the span's chord to touch on one of its
/// legs, from that leg on in which they first do.
void ContactFinder::find_first_legs(const Step& step, const LegSpan& span, const Part& part) {
  const OrganMotion organ = step.organ_motion(span);
  touches_.clear();
  for (const OpenFace& open : open_faces_) {
    touches_.push_back({open.face, organ.face(step.organ().faces()[open.face]), {}});
  }
  with_part(step, span, part.shape, part.link, [&](const PartLeg& on_chord) {
    find_touches(on_chord, part.shape, on_chord.radius + span.deviation + tolerance::kTouch);
  });
  open_faces_.clear();
  for (const FaceTouch& touch : touches_) {
    if (!touch.first) continue;
    const ClosestPoints& closest = touch.first->closest;
    const bool is_direction = !part.is_surface() && closest.distance > tolerance::kPierced;
    open_faces_.push_back(
        {touch.face, step.leg_at(span, touch.first->time),
         is_direction ? closest.separation.normalized() : Eigen::Vector3d::Zero()});
  }
}

/// Confirms the open faces that may touch on a leg by exact distances.
void ContactFinder::touch_on_leg(const Step& step, std::size_t leg, const Part& part,
                                 std::vector<FaceContact>& contacts) {
  const auto is_due = [leg](const OpenFace& open) { return open.leg <= leg; };
  if (std::none_of(open_faces_.begin(), open_faces_.end(), is_due)) return;
  const OrganMotion organ = step.organ_motion(step.span_of(leg));
  with_part(step, step.span_of(leg), part.shape, part.link, [&](const PartLeg& on_leg) {
    touches_.clear();
    for (const OpenFace& open : open_faces_) {
      if (!is_due(open)) continue;
      const FaceMotion face = organ.face(step.organ().faces()[open.face]);
      // The plane that parted them before does so on most legs of a hand that trembles.
      if (stays_beyond(open.normal, on_leg.core, face, on_leg.radius + tolerance::kTouch)) continue;
      touches_.push_back({open.face, face, {}});
    }
    find_touches(on_leg, part.shape, on_leg.radius);
    for (const FaceTouch& touch : touches_) {
      if (!touch.first) continue;
      contacts.push_back(contact_of(*touch.first, on_leg, step.face(leg, touch.face)));
      contacts.back().face = touch.face;
      touched_leg_[touch.face] = static_cast<std::uint32_t>(leg + 1);
    }
  });
}

/// When each of `touches_` first comes within `radius` of the part.
void ContactFinder::find_touches(const PartLeg& part, const LinkPart* shape, double radius) {
  if (touches_.empty()) return;
  if (shape && shape->surface) {
    find_first_touches(*shape->surface, *part.core.link(), radius, budget_, touches_);
  } else {
    for (FaceTouch& touch : touches_) {
      touch.first = first_touch(part.core, touch.motion, radius, budget_);
    }
  }
}

/// Whether a face is of interest on a leg: touches later than its first are not.
bool ContactFinder::is_open(std::uint32_t face, std::size_t leg) const {
  return touched_leg_[face] == 0 || touched_leg_[face] > leg;
}

/// For the next link, which has touched none so far.
void ContactFinder::open_all(const std::vector<FaceContact>& touched, std::size_t begin) {
  for (std::size_t i = begin; i < touched.size(); ++i) touched_leg_[touched[i].face] = 0;
}

}  // namespace organ_collision
