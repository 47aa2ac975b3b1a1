#include "organ_collision/query/collision_query.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

#include "organ_collision/picking/viewing_volume.hpp"
#include "organ_collision/query/contact_refiner.hpp"
#include "request_check.hpp"
#include "step.hpp"

namespace organ_collision {
namespace {

bool is_paper_mode(QueryMode mode) {
  return mode != QueryMode::kStatic && mode != QueryMode::kSwept;
}

ViewingVolume paper_volume(const CollisionRequest& request) {
  const ShaftMotion motion{request.path.front().axis, request.path.back().axis};
  if (request.mode == QueryMode::kPaperSwept) return paper_swept_volume(motion, request.radius);
  if (request.mode == QueryMode::kPaperNaive) return paper_naive_volume(motion, request.radius);
  return paper_static_volume(motion.end, request.radius);
}

/// Sorts by face; of a face touched in several legs, the first touch stays.
void keep_first_touches(std::vector<FaceContact>& contacts) {
  std::sort(contacts.begin(), contacts.end(), [](const FaceContact& a, const FaceContact& b) {
    return std::tie(a.face, a.fraction) < std::tie(b.face, b.fraction);
  });
  const auto end = std::unique(contacts.begin(), contacts.end(),
                               [](const auto& a, const auto& b) { return a.face == b.face; });
  contacts.erase(end, contacts.end());
}

}  // namespace

CollisionQuery::CollisionQuery(PickerKind kind)
    : context_(std::make_unique<GlContext>()),
      picker_(make_picker(kind, *context_)),
      region_clipper_(*context_) {}

void CollisionQuery::evaluate(const CollisionRequest& request, CollisionResult& result) {
  result.contacts.clear();
  result.regions.clear();
  check(request);
  if (is_paper_mode(request.mode)) return pick_unrefined(request, result);

  // The method: a camera's viewing volume is given the shape of the space that the tool swept, the
  // organ is drawn in a picking mode, and exact distances decide on what survives clipping.
  const Step step(request, displacement_);
  for (std::size_t leg = 0; leg < step.leg_count(); ++leg) {
    picker_->pick(conservative_volume(step.shaft(leg), request.radius, step.margin(leg)),
                  *request.organ, candidates_);
    for (const Candidate& candidate : candidates_) {
      std::optional<FaceContact> contact = refine(step.leg(leg, candidate.face), request.radius);
      if (!contact) continue;
      contact->face = candidate.face;
      result.contacts.push_back(*contact);
    }
  }
  keep_first_touches(result.contacts);
  if (request.regions) clip_regions(request, step, result);
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

/// Each contact's face, as it is at the end of the step, in the volume of the leg that touched it.
void CollisionQuery::clip_regions(const CollisionRequest& request, const Step& step,
                                  CollisionResult& result) {
  result.regions.resize(result.contacts.size());
  for (std::size_t leg = 0; leg < step.leg_count(); ++leg) {
    faces_.clear();
    for (const FaceContact& contact : result.contacts) {
      if (step.leg_at(contact.fraction) == leg) faces_.push_back(contact.face);
    }
    if (faces_.empty()) continue;
    std::vector<Region> regions =
        region_clipper_.clip(tool_volume(step.shaft(leg), request.radius), *request.organ, faces_);
    for (std::size_t i = 0, next = 0; i < result.contacts.size(); ++i) {
      if (step.leg_at(result.contacts[i].fraction) == leg) result.regions[i].swap(regions[next++]);
    }
  }
}

}  // namespace organ_collision
