#include "contact_finder.hpp"

#include <algorithm>
#include <tuple>

#include "request_check.hpp"

namespace organ_collision {
namespace {

/// The space that a part sweeps along the chord of a span, grown so that it contains the part on
/// all legs of the span.
PartSweep sweep_of(const Step& step, const LegSpan& span, const ToolPart& part) {
  if (!part.shape) return {step.shaft_motion(span), step.radius() + span.deviation};
  return PartSweep(SweptBox(part.shape->bounds, step.link_motion(span, part.link),
                            part.shape->radius + span.deviation));
}

/// Sorts the contacts by face, then link, and keeps one for each face and link: the first touch,
/// and of several touches at that time the deepest. Parts that pierce a face together have the same
/// depth. The point decides between them, so that the answer does not depend on the order of parts.
void keep_first_touches(std::vector<FaceContact>& contacts) {
  const auto precedes = [](const FaceContact& a, const FaceContact& b) {
    return std::tie(a.face, a.link, a.fraction, b.depth, a.point.x(), a.point.y(), a.point.z()) <
           std::tie(b.face, b.link, b.fraction, a.depth, b.point.x(), b.point.y(), b.point.z());
  };
  // The contacts of a shaft on one leg are sorted already.
  if (!std::is_sorted(contacts.begin(), contacts.end(), precedes)) {
    std::sort(contacts.begin(), contacts.end(), precedes);
  }
  const auto end = std::unique(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
    return a.face == b.face && a.link == b.link;
  });
  contacts.erase(end, contacts.end());
}

}  // namespace

/// The method, for one part of the tool. The span has one leg if the tool moved straight from its
/// last pose to this one, as in the paper.
void ContactFinder::find_part_contacts(const Step& step, const LegSpan& span, const ToolPart& part,
                                       std::vector<FaceContact>& contacts) {
  // Section 4, figures 7 and 8: a viewing volume stands around the space that the part sweeps. The
  // picker builds it for the faces that it draws (see doc/geometry.md, Conservative wedge). The
  // paper's own volume misses parts of that space; this one contains all of it.
  const PartSweep swept = sweep_of(step, span, part);

  // Section 2: OpenGL draws the organ in a picking mode. The faces that survive clipping to the
  // volume are the candidates.
  picker_.pick(swept, step.organ_motion(span), candidates_);

  // Beyond the paper: exact distances confirm the candidates that the part touches, and tell when
  // and where each is touched first.
  confirmer_.confirm(step, span, part, candidates_, contacts);
}

void ContactFinder::find(const Step& step, std::vector<FaceContact>& contacts) {
  confirmer_.start(step);
  for_each_part(step, [&](const ToolPart& part, const LegSpan& span) {
    find_part_contacts(step, span, part, contacts);
  });
  keep_first_touches(contacts);
  for (FaceContact& contact : contacts) contact.vertices = step.organ().faces()[contact.face];
}

void ContactFinder::find_in_paper_volume(const CollisionRequest& request,
                                         std::vector<FaceContact>& contacts) {
  picker_.pick(paper_volume(request), *request.organ, candidates_);
  for (const Candidate& candidate : candidates_) {
    FaceContact contact;
    contact.face = candidate.face;
    contact.view_min = candidate.view_min;
    contact.view_max = candidate.view_max;
    contacts.push_back(contact);
  }
}

}  // namespace organ_collision
