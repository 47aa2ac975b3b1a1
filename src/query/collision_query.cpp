#include "organ_collision/query/collision_query.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

#include "organ_collision/picking/viewing_volume.hpp"
#include "organ_collision/query/contact_refiner.hpp"
#include "request_check.hpp"
#include "short_turns.hpp"
#include "step.hpp"

namespace organ_collision {
namespace {

ViewingVolume paper_volume(const CollisionRequest& request) {
  const ShaftMotion motion{request.path.front().axis, request.path.back().axis};
  if (request.mode == QueryMode::kPaperSwept) return paper_swept_volume(motion, request.radius);
  if (request.mode == QueryMode::kPaperNaive) return paper_naive_volume(motion, request.radius);
  return paper_static_volume(motion.end, request.radius);
}

/// Sorts by face, then link; of a face that a link touched in several legs or with several parts,
/// the first touch stays, of several the deepest. Parts that pierce a face together are as deep:
/// the point decides, so that other contacts do not.
void keep_first_touches(std::vector<FaceContact>& contacts) {
  std::sort(contacts.begin(), contacts.end(), [](const FaceContact& a, const FaceContact& b) {
    return std::tie(a.face, a.link, a.fraction, b.depth, a.point.x(), a.point.y(), a.point.z()) <
           std::tie(b.face, b.link, b.fraction, a.depth, b.point.x(), b.point.y(), b.point.z());
  });
  const auto end = std::unique(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
    return a.face == b.face && a.link == b.link;
  });
  contacts.erase(end, contacts.end());
}

}  // namespace

CollisionQuery::CollisionQuery(PickerKind kind)
    : context_(std::make_unique<GlContext>()),
      picker_(make_picker(kind, *context_)),
      region_clipper_(*context_) {
  context_->release();
}

void CollisionQuery::evaluate(const CollisionRequest& request, CollisionResult& result) {
  result.contacts.clear();
  result.regions.clear();
  result.unresolved = 0;
  budget_ = {};
  check(request);
  const ScopedCurrentContext current(*context_);
  if (is_paper_mode(request.mode)) return pick_unrefined(request, result);

  // The method: a camera's viewing volume is given the shape of the space that a part of the tool
  // swept, the organ is drawn in a picking mode, and exact distances decide on what survives
  // clipping.
  const Step step(request, with_short_turns(request.path, finer_path_), displacement_);
  for (std::size_t leg = 0; leg < step.leg_count(); ++leg) {
    if (step.has_shaft()) touch_shaft(step, leg, result.contacts);
    for (std::size_t link = 0; link < step.link_count(); ++link) {
      touch_link(step, leg, link, result.contacts);
    }
  }
  keep_first_touches(result.contacts);
  for (FaceContact& contact : result.contacts) {
    contact.vertices = step.organ().faces()[contact.face];
    if (!contact.is_resolved) ++result.unresolved;
  }
  if (request.regions) clip_regions(step, result);
}

void CollisionQuery::touch_shaft(const Step& step, std::size_t leg,
                                 std::vector<FaceContact>& contacts) {
  const ShaftMotion shaft = step.shaft(leg);
  const VolumeMargin margin = step.margin(shaft.start.trocar);
  picker_->pick(conservative_volume(shaft, step.radius(), margin), step.organ(), candidates_);
  touch_core(step, leg, {shaft, step.radius(), step.shaft_end()}, contacts);
}

void CollisionQuery::touch_link(const Step& step, std::size_t leg, std::size_t link,
                                std::vector<FaceContact>& contacts) {
  const RigidMotion motion = step.link_motion(leg, link);
  for (const LinkPart& part : step.link(link).parts) {
    const SweptBox box(part.bounds, motion, part.radius);
    picker_->pick(conservative_volume(box, step.margin(box.origin())), step.organ(), candidates_);
    const PartLeg on_leg{{part.core, motion}, part.radius, step.link_end(link), step.number(link)};
    if (part.surface) {
      touch_surface(step, leg, on_leg, *part.surface, contacts);
    } else {
      touch_core(step, leg, on_leg, contacts);
    }
  }
}

/// Confirms candidates by their distance from a convex part.
void CollisionQuery::touch_core(const Step& step, std::size_t leg, const PartLeg& part,
                                std::vector<FaceContact>& contacts) {
  budget_.add_pairs(step.organ().face_count());
  for (const Candidate& candidate : candidates_) {
    std::optional<FaceContact> contact = refine(part, step.face(leg, candidate.face), budget_);
    if (!contact) continue;
    contact->face = candidate.face;
    contacts.push_back(*contact);
  }
}

/// Confirms candidates face against face.
void CollisionQuery::touch_surface(const Step& step, std::size_t leg, const PartLeg& part,
                                   const ToolSurface& surface, std::vector<FaceContact>& contacts) {
  budget_.add_pairs(step.organ().face_count() * surface.faces().size());
  touches_.clear();
  for (const Candidate& candidate : candidates_) {
    touches_.push_back({candidate.face, step.face(leg, candidate.face).motion, {}});
  }
  find_first_touches(surface, *part.core.link(), part.radius, budget_, touches_);
  for (const FaceTouch& touch : touches_) {
    if (!touch.first) continue;
    contacts.push_back(contact_of(*touch.first, part, step.face(leg, touch.face)));
    contacts.back().face = touch.face;
  }
}

void CollisionQuery::pick_unrefined(const CollisionRequest& request, CollisionResult& result) {
  picker_->pick(paper_volume(request), *request.organ, candidates_);
  for (const Candidate& candidate : candidates_) {
    FaceContact contact;
    contact.face = candidate.face;
    contact.view_min = candidate.view_min;
    contact.view_max = candidate.view_max;
    result.contacts.push_back(contact);
  }
}

/// Each contact's face, as it is at the end of the step, in the volume of the leg that touched it:
/// the shaft's, or that of the link's first part whose volume it meets.
void CollisionQuery::clip_regions(const Step& step, CollisionResult& result) {
  result.regions.resize(result.contacts.size());
  for (std::size_t leg = 0; leg < step.leg_count(); ++leg) {
    if (step.has_shaft()) {
      clip_regions(tool_volume(step.shaft(leg), step.radius()), step, leg, 0, result);
    }
    for (std::size_t link = 0; link < step.link_count(); ++link) {
      const RigidMotion motion = step.link_motion(leg, link);
      for (const LinkPart& part : step.link(link).parts) {
        const SweptBox box(part.bounds, motion, part.radius);
        clip_regions(tool_volume(box), step, leg, step.number(link), result);
      }
    }
  }
}

/// Of the contacts of one leg and link that have no region yet.
void CollisionQuery::clip_regions(const ViewingVolume& volume, const Step& step, std::size_t leg,
                                  std::uint32_t link, CollisionResult& result) {
  faces_.clear();
  const auto is_due = [&](std::size_t i) {
    const FaceContact& contact = result.contacts[i];
    return contact.link == link && step.leg_at(contact.fraction) == leg &&
           result.regions[i].empty();
  };
  for (std::size_t i = 0; i < result.contacts.size(); ++i) {
    if (is_due(i)) faces_.push_back(result.contacts[i].face);
  }
  if (faces_.empty()) return;
  std::vector<Region> regions = region_clipper_.clip(volume, step.organ(), faces_);
  for (std::size_t i = 0, next = 0; i < result.contacts.size(); ++i) {
    if (is_due(i)) result.regions[i].swap(regions[next++]);
  }
}

}  // namespace organ_collision
