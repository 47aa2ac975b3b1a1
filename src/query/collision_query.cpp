#include "collision_query.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "clearance_finder.hpp"
#include "contact_finder.hpp"
#include "leg_span.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "placement_finder.hpp"
#include "request_check.hpp"

namespace organ_collision {
namespace {

Region region_of(const TriangleMesh& organ, const FaceContact& contact,
                 const ViewingVolume& volume) {
  Region region = clipped(shifted(organ.triangle(contact.face), volume.origin()), volume);
  for (Eigen::Vector3d& corner : region) corner += volume.origin();
  return region;
}

}  // namespace

void ContactRegions::find(const Step& step, const std::vector<FaceContact>& contacts,
                          std::vector<Region>& regions) {
  regions.assign(contacts.size(), {});
  places_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    places_.push_back({step.leg_at(contacts[i].fraction), contacts[i].link, i});
  }
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return std::tie(a.leg, a.link, a.contact) < std::tie(b.leg, b.link, b.contact);
  });
  for (Places begin = places_.begin(); begin != places_.end();) {
    const Places end = std::find_if_not(
        begin, places_.cend(), [&](const Place& place) { return place.shares_volumes(*begin); });
    clip(step, begin, end, contacts, regions);
    begin = end;
  }
}

/// Finds the regions of contacts that share leg and link.
void ContactRegions::clip(const Step& step, Places begin, Places end,
                          const std::vector<FaceContact>& contacts, std::vector<Region>& regions) {
  if (step.has_shaft() && begin->link == 0) {
    const ViewingVolume volume = tool_volume(step.shaft_motion(begin->leg), step.radius());
    for (Places place = begin; place != end; ++place) {
      regions[place->contact] = region_of(step.organ(), contacts[place->contact], volume);
    }
    return;
  }
  const std::size_t link = begin->link - step.link_number(0);
  const RigidMotion motion = step.link_motion(begin->leg, link);
  for (const LinkPart& part : step.link(link).parts) {
    const SweptBox box(part.bounds, motion, part.radius);
    const ViewingVolume volume = tool_volume(box);
    for (Places place = begin; place != end; ++place) {
      Region& region = regions[place->contact];
      if (region.empty()) region = region_of(step.organ(), contacts[place->contact], volume);
    }
  }
}

namespace {

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

void clear(CollisionResult& result) {
  result.contacts.clear();
  result.regions.clear();
  result.unresolved = 0;
  result.near.clear();
  result.near_left_out = 0;
  result.near_unresolved = 0;
  result.clearance = {};
  result.placement.crossings.clear();  // They keep their memory.
  result.placement = {{}, {}, std::move(result.placement.crossings), false, 0.0};
}

/// The faces in the paper's volumes, with their depth ranges and nothing else.
void pick_unrefined(const CollisionRequest& request, Picker& picker,
                    std::vector<Candidate>& candidates, std::vector<FaceContact>& contacts) {
  picker.pick(paper_volume(request), *request.organ, candidates);
  for (const Candidate& candidate : candidates) {
    FaceContact contact;
    contact.face = candidate.face;
    contact.view_min = candidate.view_min;
    contact.view_max = candidate.view_max;
    contacts.push_back(contact);
  }
}

/// Releases the picker at the end of a query, so that any thread may ask the next one.
class ScopedRelease {
 public:
  explicit ScopedRelease(Picker& picker) : picker_(picker) {}
  ~ScopedRelease() { picker_.release(); }
  ScopedRelease(const ScopedRelease&) = delete;
  ScopedRelease& operator=(const ScopedRelease&) = delete;

 private:
  Picker& picker_;
};

}  // namespace

struct CollisionQuery::State {
  explicit State(const PickerSettings& settings)
      : picker(make_picker(settings)), finder(*picker), placement(*picker) {}

  void evaluate(const CollisionRequest& request, CollisionResult& result);

  std::unique_ptr<Picker> picker;
  ContactFinder finder;
  ContactRegions regions;
  ClearanceFinder clearance;
  NearFinder near;
  PlacementFinder placement;
  std::vector<Candidate> candidates;
  BlockBoxes boxes_before;
  ToolPath subdivided_path;
};

CollisionQuery::CollisionQuery(const PickerSettings& settings)
    : state_(std::make_unique<State>(settings)) {}
CollisionQuery::~CollisionQuery() = default;
CollisionQuery::CollisionQuery(CollisionQuery&&) noexcept = default;
CollisionQuery& CollisionQuery::operator=(CollisionQuery&&) noexcept = default;

const std::string& CollisionQuery::gl_version() const { return state_->picker->gl_version(); }

void CollisionQuery::evaluate(const CollisionRequest& request, CollisionResult& result) {
  clear(result);
  check(request);
  try {
    const ScopedRelease release(*state_->picker);
    state_->evaluate(request, result);
  } catch (...) {
    clear(result);
    throw;
  }
}

/// The pipeline: contacts of all parts and legs, one for each face and link; then what else the
/// request asks for.
void CollisionQuery::State::evaluate(const CollisionRequest& request, CollisionResult& result) {
  if (is_paper_mode(request.mode)) {
    return pick_unrefined(request, *picker, candidates, result.contacts);
  }
  const Step step(request, with_subdivided_rotations(request.path, subdivided_path), boxes_before);
  finder.find(step, result.contacts);
  keep_first_touches(result.contacts);
  for (FaceContact& contact : result.contacts) {
    contact.vertices = request.organ->faces()[contact.face];
    if (!contact.is_resolved) ++result.unresolved;
  }
  if (request.regions) regions.find(step, result.contacts, result.regions);
  if (asks_for_clearance(request)) {
    result.clearance = clearance.find(step, request, result.contacts);
  }
  if (request.max_near > 0) near.find(step, request, result);
  if (request.placement) placement.find(request, result.placement);
}

}  // namespace organ_collision
