#include "clearance_finder.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "contact_refiner.hpp"
#include "geometry/distance/swept_box.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

/// A box around the space that a part's core covers along the chord of a span.
OrientedBox box_around(const Step& step, const LegSpan& span, const ToolPart& part) {
  if (!part.shape) return box_around(step.shaft_motion(span));
  return SweptBox(part.shape->bounds, step.link_motion(span, part.link), 0.0).bounds();
}

/// The closest approach of a part and a face, unless the budget is used up. Tells the sink if it
/// may be missing or too far.
std::optional<ClosestApproach> measured(const ToolPart& part, const PartLeg& leg,
                                        const OrganMotion& organ, std::uint32_t face,
                                        double distance_bound, WorkBudget& budget,
                                        ApproachSink& sink) {
  const FaceMotion motion = organ.face(organ.after().faces()[face]);
  const std::uint64_t cuts = budget.cuts();
  std::optional<ClosestApproach> approach;
  if (budget.is_used_up()) {
    budget.add_cut();
  } else if (part.is_surface()) {
    approach =
        closest_approach(*part.shape->surface, *leg.core.link(), motion, distance_bound, budget);
  } else {
    approach = closest_approach(leg.core, motion, distance_bound, budget);
  }
  if (budget.cuts() != cuts) sink.add_unresolved(face);
  return approach;
}

}  // namespace

void ApproachFinder::find(const Step& step, WorkBudget& budget, ApproachSink& sink) {
  for_each_part(step, [&](const ToolPart& part, const LegSpan& span) {
    budget.add_pairs(span.leg_count() * step.organ().face_count() * part.convex_count());
    find_near_chord(step, span, part, budget, sink);
    for (std::size_t leg = span.begin; leg < span.end && !faces_.empty(); ++leg) {
      find_on_leg(step, leg, part, budget, sink);
    }
  });
}

/// Measures the faces along the chord of a span. If the span has a single leg, which is its chord,
/// these are the approaches. Else the faces that come near the chord are kept for its legs.
void ApproachFinder::find_near_chord(const Step& step, const LegSpan& span, const ToolPart& part,
                                     WorkBudget& budget, ApproachSink& sink) {
  const OrganMotion organ = step.organ_motion(span);
  const double radius = part.surface_radius(step);
  const auto bound = [&] { return sink.bound() + radius + span.deviation; };
  faces_.clear();
  with_part_leg(step, span, part, [&](const PartLeg& on_chord) {
    search_.visit(organ, box_around(step, span, part), bound, [&](std::uint32_t face) {
      if (!sink.accepts(face)) return;
      const auto approach = measured(part, on_chord, organ, face, bound(), budget, sink);
      if (!approach) return;
      if (span.leg_count() > 1) return faces_.push_back(face);
      sink.add({approach->closest.distance - radius, face, part, span.begin, *approach});
    });
  });
}

/// Measures the faces that come near the chord on one leg.
void ApproachFinder::find_on_leg(const Step& step, std::size_t leg, const ToolPart& part,
                                 WorkBudget& budget, ApproachSink& sink) const {
  const OrganMotion organ = step.organ_motion(step.span_of(leg));
  const double radius = part.surface_radius(step);
  with_part_leg(step, step.span_of(leg), part, [&](const PartLeg& on_leg) {
    for (const std::uint32_t face : faces_) {
      if (!sink.accepts(face)) continue;
      const auto approach =
          measured(part, on_leg, organ, face, sink.bound() + radius, budget, sink);
      if (approach) {
        sink.add({approach->closest.distance - radius, face, part, leg, *approach});
      }
    }
  });
}

namespace {

/// Keeps the nearest approach.
class Nearest : public ApproachSink {
 public:
  explicit Nearest(double distance_bound) : bound_(distance_bound) {}

  double bound() const override { return bound_; }
  /// Of faces at the same distance, the one with the smallest number is kept.
  void add(const PartApproach& approach) override {
    const bool is_tie = nearest_ && approach.distance == nearest_->distance;
    if (is_tie && approach.face > nearest_->face) return;
    nearest_ = approach;
    bound_ = approach.distance;
  }
  const std::optional<PartApproach>& get() const { return nearest_; }

 private:
  double bound_;  ///< [m]
  std::optional<PartApproach> nearest_;
};

/// Sets what the clearance tells about the end of the step. `step`: of zero duration.
void set_end(const Step& step, const PartApproach& nearest, ToolClearance& clearance) {
  const ClosestPoints& closest = nearest.approach.closest;
  const FaceLeg face = step.face_leg(0, nearest.face);
  FaceContact contact;
  with_part_leg(step, step.span_of(0), nearest.part, [&](const PartLeg& part) {
    contact = contact_of(FirstTouch{0.0, closest}, part, face);
  });
  clearance.state = ClearanceState::kKnown;
  clearance.distance = nearest.distance;
  clearance.face = nearest.face;
  clearance.vertices = step.organ().faces()[nearest.face];
  clearance.barycentric = contact.barycentric;
  clearance.link = contact.link;
  clearance.on_organ = contact.point;
  clearance.on_tool = contact.point - nearest.distance * contact.normal;
  clearance.normal = contact.normal;
  clearance.normal_defined = closest.distance > tolerance::kPierced;
}

}  // namespace

ToolClearance ClearanceFinder::find(const Step& step, const CollisionRequest& request,
                                    const std::vector<FaceContact>& contacts, WorkBudget budget) {
  budget_ = budget;
  ToolClearance clearance;
  clearance.unlimited = request.clearance;
  clearance.margin = request.clearance ? 0.0 : request.margin;
  clearance.state = ClearanceState::kBeyondMargin;
  const double limit = request.clearance ? std::numeric_limits<double>::infinity() : request.margin;
  if (const auto end = nearest(step.at_end(), limit)) {
    set_end(step.at_end(), *end, clearance);
    set_least(step, request, contacts, clearance);
  }
  if (budget_.cuts() > 0) clearance.is_resolved = false;
  return clearance;
}

/// Sets the smallest distance during the step. The distances at its start and its end are bounds
/// from which the search begins.
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
    clearance.least_fraction = step.fraction_at(between->leg, between->approach.time);
  }
}

std::optional<PartApproach> ClearanceFinder::nearest(const Step& step, double distance_bound) {
  Nearest sink(distance_bound);
  approaches_.find(step, budget_, sink);
  return sink.get();
}

namespace {

constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kTouched = kNothing - 1;
constexpr std::uint32_t kUnresolved = kNothing - 2;

/// The contact that stands for a near face.
FaceContact contact_of(const Step& step, const PartApproach& near) {
  FaceContact contact;
  with_part_leg(step, step.span_of(near.leg), near.part, [&](const PartLeg& part) {
    contact = contact_of(FirstTouch{near.approach.time, near.approach.closest}, part,
                         step.face_leg(near.leg, near.face));
  });
  contact.face = near.face;
  contact.vertices = step.organ().faces()[near.face];
  contact.depth = -near.distance;
  return contact;
}

}  // namespace

/// Keeps for each face the approach with the smallest distance, unless it may come nearer.
class NearFinder::Collector : public ApproachSink {
 public:
  Collector(double margin, NearFinder& finder)
      : margin_(margin), nearest_(finder.nearest_), places_(finder.places_) {}

  double bound() const override { return margin_; }
  bool accepts(std::uint32_t face) const override {
    return places_[face] != kTouched && places_[face] != kUnresolved;
  }
  void add(const PartApproach& approach) override {
    std::uint32_t& place = places_[approach.face];
    if (place == kUnresolved) return;
    if (place == kNothing) {
      place = static_cast<std::uint32_t>(nearest_.size());
      nearest_.push_back(approach);
    } else if (approach.distance < nearest_[place].distance) {
      nearest_[place] = approach;
    }
  }
  void add_unresolved(std::uint32_t face) override { places_[face] = kUnresolved; }

 private:
  double margin_;  ///< [m]
  std::vector<PartApproach>& nearest_;
  std::vector<std::uint32_t>& places_;
};

void NearFinder::find(const Step& step, const CollisionRequest& request, CollisionResult& result,
                      WorkBudget budget) {
  nearest_.clear();
  places_.assign(step.organ().face_count(), kNothing);
  for (const FaceContact& contact : result.contacts) places_[contact.face] = kTouched;
  Collector collector(request.margin, *this);
  approaches_.find(step, budget, collector);

  const auto is_unresolved = [&](const PartApproach& near) {
    return places_[near.face] == kUnresolved;
  };
  nearest_.erase(std::remove_if(nearest_.begin(), nearest_.end(), is_unresolved), nearest_.end());
  const std::size_t count = std::min(request.max_near, nearest_.size());
  const auto end = nearest_.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(nearest_.begin(), end, nearest_.end(), [](const auto& a, const auto& b) {
    return std::tie(a.distance, a.face) < std::tie(b.distance, b.face);
  });
  for (auto near = nearest_.begin(); near != end; ++near) {
    result.near.push_back(contact_of(step, *near));
  }
  result.near_left_out = nearest_.size() - count;
  result.near_unresolved =
      static_cast<std::size_t>(std::count(places_.begin(), places_.end(), kUnresolved));
}

}  // namespace organ_collision
