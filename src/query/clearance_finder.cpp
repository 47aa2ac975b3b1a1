#include "clearance_finder.hpp"

#include <algorithm>
#include <limits>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// ToolClearance::closing_speed. `end`: the nearest approach at the end of the step. `normal`: from
/// the tool to the organ. The smallest distance changes as the distance of the two points that are
/// nearest now, if they move with the tool and with the organ (Danskin's theorem).
double closing_speed(const Step& at_end, const CollisionRequest& request, const Approach& end,
                     const Vector3d& normal) {
  const ClosestPoints& closest = end.closest.closest;
  Vector3d velocity = -tissue_velocity(request, end.face, closest.barycentric);
  const PartOnLeg part(at_end, at_end.span_of(0), end.part);
  velocity += part->moved_since(*request.pose_before, closest) / request.pose_before_sec;
  return normal.dot(velocity);
}

/// The contact whose fields describe an approach, as if it were a first touch.
FaceContact contact_of(const Step& step, const Approach& near) {
  const PartOnLeg part(step, step.span_of(near.leg), near.part);
  return contact_on(step, near.leg, *part, near.face, {near.closest.time, near.closest.closest});
}

}  // namespace

ToolClearance ClearanceFinder::find(const Step& step, const CollisionRequest& request,
                                    const std::vector<FaceContact>& contacts,
                                    const NearestAtEnd& known, const WorkBudget& budget) {
  budget_ = budget;
  ToolClearance clearance;
  clearance.unlimited = request.clearance;
  clearance.margin = request.clearance ? 0.0 : request.margin;
  clearance.state = ClearanceState::kBeyondMargin;
  const double limit = request.clearance ? std::numeric_limits<double>::infinity() : request.margin;
  const Step at_end = step.at_end();
  const bool is_known = known.is_known && (known.nearest || !request.clearance);
  if (const auto end = is_known ? known.nearest : nearest(at_end, limit)) {
    const FaceContact contact = contact_of(at_end, *end);
    clearance.state = ClearanceState::kKnown;
    clearance.distance = end->distance;
    clearance.face = contact.face;
    clearance.vertices = contact.vertices;
    clearance.barycentric = contact.barycentric;
    clearance.link = contact.link;
    clearance.on_organ = contact.point;
    clearance.on_tool = contact.point - end->distance * contact.normal;
    clearance.normal = contact.normal;
    clearance.normal_defined = end->closest.closest.distance > tolerance::kPierced;
    if (request.pose_before && request.mode != QueryMode::kStatic) {
      clearance.closing_speed = closing_speed(at_end, request, *end, contact.normal);
    }
    set_least(step, request, contacts, clearance);
  }
  if (budget_.cuts() > 0) clearance.is_resolved = false;
  return clearance;
}

/// Sets the smallest distance during the step. The search between start and end begins with the
/// smaller one of the distances at the start and at the end as its bound.
void ClearanceFinder::set_least(const Step& step, const CollisionRequest& request,
                                const std::vector<FaceContact>& contacts,
                                ToolClearance& clearance) {
  clearance.least = clearance.distance;
  if (request.mode == QueryMode::kStatic) return;
  clearance.least_fraction = 1.0;
  if (!contacts.empty()) {
    const auto first =
        std::min_element(contacts.begin(), contacts.end(),
                         [](const auto& a, const auto& b) { return a.fraction < b.fraction; });
    clearance.least = 0.0;
    clearance.least_fraction = first->fraction;
    clearance.is_resolved = first->is_resolved;
    return;
  }
  if (const auto start = nearest(step.at_start(), clearance.least)) {
    clearance.least = start->distance;
    clearance.least_fraction = 0.0;
  }
  if (const auto between = nearest(step, clearance.least)) {
    clearance.least = between->distance;
    clearance.least_fraction = step.fraction_at(between->leg, between->closest.time);
  }
}

std::optional<Approach> ClearanceFinder::nearest(const Step& step, double distance_bound) {
  nearest_.start(step.organ().face_count(), 1, distance_bound);
  find_approaches(step);
  const std::vector<Approach>& found = nearest_.found();
  return found.empty() ? std::nullopt : std::optional<Approach>(found.front());
}

/// Searches one face more than asked for, which tells near_more.
NearestAtEnd ClearanceFinder::find_near(const Step& step, const CollisionRequest& request,
                                        CollisionResult& result, std::optional<WorkBudget> budget) {
  if (!budget) {
    std::size_t parts = 0;
    for_each_part(step.at_end(), [&](const ToolPart&, const LegSpan&) { ++parts; });
    budget = WorkBudget::for_near(request.max_near, parts * step.leg_count());
  }
  budget_ = *budget;
  unmeasured_ = 0;
  nearest_.start(step.organ().face_count(), request.max_near + 1, request.margin);
  for (const FaceContact& contact : result.contacts) nearest_.exclude(contact.face);
  find_approaches(step);
  for (const Approach& near : nearest_.sorted()) {
    result.near_more = result.near.size() == request.max_near;
    if (result.near_more) break;
    result.near.push_back(contact_of(step, near));
    result.near.back().depth = -near.distance;
  }
  result.near_unresolved = std::min(unmeasured_, step.organ().face_count());
  if (!step.is_at_rest() || !result.contacts.empty() || unmeasured_ > 0) return {};
  const std::vector<Approach>& found = nearest_.found();
  return {true, found.empty() ? std::nullopt : std::optional<Approach>(found.front())};
}

/// Measures faces against a part of the tool on one leg, or along the chord of a span. The step
/// must outlive this.
class ClearanceFinder::LegSearch {
 public:
  LegSearch(ClearanceFinder& finder, const Step& step, const LegSpan& span, const ToolPart& part)
      : finder_(finder),
        organ_(step.organ_motion(span)),
        part_(part),
        moving_(step, span, part),
        box_(moving_->bounds()),
        leg_(span.begin),
        radius_(moving_->surface_radius()),
        deviation_(span.deviation),
        rounding_(kRounding * (organ_.extent(Vector3d::Zero()) + box_.center.cwiseAbs().sum() +
                               box_.half_size.sum())) {
    set_plane();
  }

  /// Calls use(face, closest approach) for each face that comes within the bound, the nearest ones
  /// first, until `use` returns false or the budget is used up. Returns how many faces are left.
  template <typename Use>
  std::size_t visit(Use use) {
    const auto bound = [this] { return this->bound(); };
    return finder_.search_.visit(organ_, box_, bound, [&](std::uint32_t face) {
      if (finder_.budget_.is_used_up()) return false;
      const auto closest = measure(face);
      return !closest || use(face, *closest);
    });
  }

  /// The closest approach to a face, unless it is beyond the bound. If the budget is used up, it
  /// may be missing or too far away.
  std::optional<ClosestApproach> measure(std::uint32_t face) {
    if (finder_.nearest_.is_excluded(face)) return std::nullopt;
    const FaceMotion motion = organ_.face(organ_.after().faces()[face]);
    if (plane_ && plane_->keeps_beyond(motion, bound() + rounding_)) return std::nullopt;
    WorkBudget& budget = finder_.budget_;
    const std::uint64_t cuts = budget.cuts();
    std::optional<ClosestApproach> closest;
    if (budget.is_used_up()) {
      budget.add_cut();
    } else {
      closest = moving_->closest_approach(motion, bound(), budget);
    }
    finder_.unmeasured_ += budget.cuts() - cuts;
    if (closest) turn_plane(closest->closest);
    return closest;
  }

  void add(std::uint32_t face, const ClosestApproach& closest) {
    finder_.nearest_.add({closest.closest.distance - radius_, face, part_, leg_, closest});
  }

 private:
  /// [1] The allowance for rounding of FixedPlane, as a share of the largest coordinates.
  static constexpr double kRounding = 1e-14;

  /// [m] The distance of a core and a face up to which the face is of interest.
  double bound() const { return finder_.nearest_.bound() + radius_ + deviation_; }

  void turn_plane(const ClosestPoints& closest) {
    Vector3d& nearest = finder_.separation_;
    const bool is_nearer = nearest.isZero(0.0) || closest.distance < nearest.norm();
    if (closest.distance <= tolerance::kPierced || !is_nearer) return;
    nearest = closest.separation;
    set_plane();
  }

  void set_plane() {
    const Vector3d normal = finder_.separation_.stableNormalized();
    if (!normal.isZero(0.0)) plane_ = moving_->plane(normal);
  }

  ClearanceFinder& finder_;
  const OrganMotion organ_;
  const ToolPart part_;
  const PartOnLeg moving_;
  const OrientedBox box_;
  const std::size_t leg_;
  const double radius_, deviation_;  ///< [m] around the core, and of the span
  const double rounding_;            ///< [m]
  std::optional<FixedPlane> plane_;
};

/// Adds the approaches of each part of the tool to `nearest_`.
void ClearanceFinder::find_approaches(const Step& step) {
  for_each_part(step, [&](const ToolPart& part, const LegSpan& span) {
    separation_.setZero();
    search_leg(step, span.begin, part);
    if (span.leg_count() == 1) return;
    const bool are_listed = list_faces_near_chord(step, span, part);
    for (std::size_t leg = span.begin + 1; leg < span.end; ++leg) {
      if (are_listed) {
        measure_listed_faces(step, leg, part);
      } else {
        search_leg(step, leg, part);
      }
    }
  });
}

void ClearanceFinder::search_leg(const Step& step, std::size_t leg, const ToolPart& part) {
  LegSearch search(*this, step, step.span_of(leg), part);
  const std::size_t left = search.visit([&](std::uint32_t face, const ClosestApproach& closest) {
    search.add(face, closest);
    return true;
  });
  if (left > 0) budget_.add_cut();
  unmeasured_ += left;
}

/// Fills `listed_` with the faces that come near the chord of a span. Returns whether they are few;
/// otherwise the list is not complete.
bool ClearanceFinder::list_faces_near_chord(const Step& step, const LegSpan& span,
                                            const ToolPart& part) {
  // If more faces come near the chord, then each leg is searched by itself. The first term is about
  // what a search costs, and the second one what it finds.
  const std::size_t most = 64 + 2 * nearest_.found().size();
  listed_.clear();
  LegSearch search(*this, step, span, part);
  return search.visit([&](std::uint32_t face, const ClosestApproach& /*closest*/) {
    listed_.push_back(face);
    return listed_.size() <= most;
  }) == 0;
}

void ClearanceFinder::measure_listed_faces(const Step& step, std::size_t leg,
                                           const ToolPart& part) {
  LegSearch search(*this, step, step.span_of(leg), part);
  for (const std::uint32_t face : listed_) {
    if (const auto closest = search.measure(face)) search.add(face, *closest);
  }
}

}  // namespace organ_collision
