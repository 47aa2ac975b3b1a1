#include "organ_collision/query/collision_query.hpp"

#include <algorithm>
#include <utility>

#include "around_finder.hpp"
#include "clearance_finder.hpp"
#include "contact_finder.hpp"
#include "moving_part.hpp"
#include "placement_finder.hpp"
#include "request_check.hpp"

namespace organ_collision {
namespace {

void clear(CollisionResult& result) {
  result.picked = {};
  result.contacts.clear();
  result.regions.clear();
  result.view_ranges.clear();
  result.unresolved = 0;
  result.near.clear();
  result.near_more = false;
  result.near_unresolved = 0;
  result.around.clear();
  result.around_up_to = 0.0;
  result.clearance = {};
  result.placement.crossings.clear();  // The cleared list keeps its memory.
  result.placement = {{}, {}, std::move(result.placement.crossings), false, 0.0};
}

/// The volumes that the parts of a link, or the shaft, sweep on a leg. `link` is
/// FaceContact::link.
std::vector<ViewingVolume> volumes_of(const Step& leg, std::int32_t link) {
  std::vector<ViewingVolume> volumes;
  for_each_part(leg, [&](const ToolPart& part, const LegSpan& span) {
    if (part.link == link) volumes.push_back(PartOnLeg(leg, span, part)->sweep(0.0).tool_volume());
  });
  return volumes;
}

/// Finds the region of each contact: the polygon in which the contact's face, as it is at the end
/// of the step, meets the tool's volume on the leg of the first touch. A link has a volume for each
/// part; the first one that the face meets counts.
void find_regions(const Step& step, const std::vector<FaceContact>& contacts,
                  std::vector<Region>& regions) {
  std::vector<ViewingVolume> volumes;
  std::size_t leg = 0;
  std::int32_t link = kShaft;
  for (const FaceContact& contact : contacts) {
    const std::size_t its_leg = step.leg_at(contact.fraction);
    if (volumes.empty() || its_leg != leg || contact.link != link) {
      leg = its_leg;
      link = contact.link;
      volumes = volumes_of(step.on_leg(leg), link);
    }
    const Triangle face = step.organ().triangle(contact.face);
    Region& region = regions.emplace_back();
    for (auto volume = volumes.begin(); region.empty() && volume != volumes.end(); ++volume) {
      region = region_of(face, *volume);
    }
  }
}

}  // namespace

struct CollisionQuery::State {
  explicit State(const PickerSettings& settings)
      : picker(make_picker(settings)), contacts(*picker), placement(*picker) {}

  void evaluate(const CollisionRequest& request, CollisionResult& result);
  void find_around(const Step& step, const CollisionRequest& request, CollisionResult& result);

  std::unique_ptr<Picker> picker;
  ContactFinder contacts;
  ClearanceFinder clearance;
  PlacementFinder placement;
  AroundFinder around;
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
  // In the end the picker is released, so that any thread may run the next query.
  const auto release = [](Picker* picker) { picker->release(); };
  const std::unique_ptr<Picker, decltype(release)> used(state_->picker.get(), release);
  state_->picker->reset_counts();
  try {
    state_->evaluate(request, result);
    result.picked = state_->picker->counts();
  } catch (...) {
    clear(result);
    throw;
  }
}

/// Finds the contacts first, and then what else the request asks for.
void CollisionQuery::State::evaluate(const CollisionRequest& request, CollisionResult& result) {
  if (is_paper_mode(request.mode)) return contacts.find_in_paper_volume(request, result);
  const Step step(request, with_subdivided_rotations(request.path, subdivided_path), boxes_before);
  contacts.find(step, result.contacts);
  result.unresolved = static_cast<std::size_t>(
      std::count_if(result.contacts.begin(), result.contacts.end(),
                    [](const FaceContact& contact) { return !contact.is_resolved; }));
  if (request.regions) find_regions(step, result.contacts, result.regions);
  NearestAtEnd end;
  if (request.max_near > 0) end = clearance.find_near(step, request, result);
  if (asks_for_clearance(request)) {
    result.clearance = clearance.find(step, request, result.contacts, end);
  }
  if (request.max_near > 0) find_around(step, request, result);
  for (std::vector<FaceContact>* faces : {&result.contacts, &result.near, &result.around}) {
    for (FaceContact& at : *faces) at.velocity = tissue_velocity(request, at.face, at.barycentric);
  }
  if (request.placement) placement.find(request, result.placement);
}

/// Sets `around`. The clearance must be known.
void CollisionQuery::State::find_around(const Step& step, const CollisionRequest& request,
                                        CollisionResult& result) {
  constexpr double kFarther = 0.01;  // [m]
  result.around_up_to = request.margin;
  if (result.clearance.state != ClearanceState::kKnown) return;
  const double nearest = std::min(request.margin, std::max(0.0, result.clearance.distance));
  const double farthest = std::min(request.margin, nearest + kFarther);
  result.around_up_to = around.find(step.at_end(), nearest, farthest, result.around);
}

}  // namespace organ_collision
