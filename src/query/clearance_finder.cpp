#include "clearance_finder.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "geometry/distance/swept_box.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// A box around the space that a part's core covers along the chord of a span.
OrientedBox box_around(const Step& step, const LegSpan& span, const ToolPart& part) {
  if (!part.shape) return box_around(step.shaft_motion(span));
  return SweptBox(part.shape->bounds, step.link_motion(span, part.link), 0.0).bounds();
}

// Values of ClearanceFinder::places_.
constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kTouched = kNothing - 1;
constexpr std::uint32_t kUnresolved = kNothing - 2;

}  // namespace

ToolClearance ClearanceFinder::find(const Step& step, const CollisionRequest& request,
                                    const std::vector<FaceContact>& contacts,
                                    const WorkBudget& budget) {
  budget_ = budget;
  ToolClearance clearance;
  clearance.unlimited = request.clearance;
  clearance.margin = request.clearance ? 0.0 : request.margin;
  clearance.state = ClearanceState::kBeyondMargin;
  const double limit = request.clearance ? std::numeric_limits<double>::infinity() : request.margin;
  const Step at_end = step.at_end();
  if (const auto end = nearest(at_end, limit)) {
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
    clearance.closing = closing(step, *end, contact.normal);
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

std::optional<ClearanceFinder::Approach> ClearanceFinder::nearest(const Step& step,
                                                                  double distance_bound) {
  searches_each_face_ = false;
  find_approaches(step, distance_bound);
  return found_.empty() ? std::nullopt : std::optional<Approach>(found_.front());
}

void ClearanceFinder::find_near(const Step& step, const CollisionRequest& request,
                                CollisionResult& result, const WorkBudget& budget) {
  budget_ = budget;
  searches_each_face_ = true;
  places_.assign(step.organ().face_count(), kNothing);
  for (const FaceContact& contact : result.contacts) places_[contact.face] = kTouched;
  find_approaches(step, request.margin);

  const auto is_unresolved = [&](const Approach& near) {
    return places_[near.face] == kUnresolved;
  };
  found_.erase(std::remove_if(found_.begin(), found_.end(), is_unresolved), found_.end());
  const std::size_t count = std::min(request.max_near, found_.size());
  const auto end = found_.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(found_.begin(), end, found_.end(), [](const auto& a, const auto& b) {
    return std::tie(a.distance, a.face) < std::tie(b.distance, b.face);
  });
  for (auto near = found_.begin(); near != end; ++near) {
    result.near.push_back(contact_of(step, *near));
    result.near.back().depth = -near->distance;
  }
  result.near_more = found_.size() > count;
  result.near_unresolved =
      static_cast<std::size_t>(std::count(places_.begin(), places_.end(), kUnresolved));
}

/// ToolClearance::closing. `end`: the nearest approach at the end of the step. `normal`: from the
/// tool to the organ. The smallest distance changes as the distance of the two points that are
/// nearest now, if they move with the tool and with the organ (Danskin's theorem).
double ClearanceFinder::closing(const Step& step, const Approach& end, const Vector3d& normal) {
  const ClosestPoints& closest = end.closest.closest;
  const LegSpan last = step.span_of(step.leg_count() - 1);
  const FaceLeg face = step.face_leg(last.begin, end.face);
  Vector3d way = point_at(face.motion.start, closest.barycentric) -
                 point_at(face.motion.end, closest.barycentric);
  if (!end.part.shape) {
    const ShaftMotion shaft = step.shaft_motion(last);
    way += shaft.end.at(closest.shaft) - shaft.start.at(closest.shaft);
  } else {
    const RigidMotion link = step.link_motion(last, end.part.link);
    const Vector3d arm = closest.on_core - link.end().translation();
    way += link.end().translation() - link.start().translation() +
           link.angle() * link.axis().cross(arm);
  }
  return normal.dot(way) / (face.finish - face.begin);
}

/// The contact whose fields describe an approach, as if it were a first touch.
FaceContact ClearanceFinder::contact_of(const Step& step, const Approach& near) {
  FaceContact contact;
  with_part_leg(step, step.span_of(near.leg), near.part, [&](const PartLeg& part) {
    contact = organ_collision::contact_of(FirstTouch{near.closest.time, near.closest.closest}, part,
                                          step.face_leg(near.leg, near.face));
  });
  contact.face = near.face;
  contact.vertices = step.organ().faces()[near.face];
  return contact;
}

/// Replaces `found_` by the approaches within the bound [m]: the nearest one alone, or that of each
/// face that places_ leaves to be searched.
void ClearanceFinder::find_approaches(const Step& step, double distance_bound) {
  found_.clear();
  bound_ = distance_bound;
  for_each_part(step, [&](const ToolPart& part, const LegSpan& span) {
    budget_.add_pairs(span.leg_count() * step.organ().face_count() * part.convex_count());
    find_near_chord(step, span, part);
    for (std::size_t leg = span.begin; leg < span.end && !faces_.empty(); ++leg) {
      find_on_leg(step, leg, part);
    }
  });
}

/// Measures the faces along the chord of a span. If the span has a single leg, the chord is this
/// leg, and the approaches are added. Otherwise the faces near the chord are kept in
/// `faces_`, to be measured on each leg.
void ClearanceFinder::find_near_chord(const Step& step, const LegSpan& span, const ToolPart& part) {
  const OrganMotion organ = step.organ_motion(span);
  const double radius = part.surface_radius(step);
  const auto bound = [&] { return bound_ + radius + span.deviation; };
  faces_.clear();
  with_part_leg(step, span, part, [&](const PartLeg& on_chord) {
    search_.visit(organ, box_around(step, span, part), bound, [&](std::uint32_t face) {
      if (!is_searched(face)) return;
      const auto closest = measure(part, on_chord, organ, face, bound());
      if (!closest) return;
      if (span.leg_count() > 1) return faces_.push_back(face);
      add({closest->closest.distance - radius, face, part, span.begin, *closest});
    });
  });
}

/// Measures on one leg the faces that came near the chord.
void ClearanceFinder::find_on_leg(const Step& step, std::size_t leg, const ToolPart& part) {
  const OrganMotion organ = step.organ_motion(step.span_of(leg));
  const double radius = part.surface_radius(step);
  with_part_leg(step, step.span_of(leg), part, [&](const PartLeg& on_leg) {
    for (const std::uint32_t face : faces_) {
      if (!is_searched(face)) continue;
      const auto closest = measure(part, on_leg, organ, face, bound_ + radius);
      if (closest) add({closest->closest.distance - radius, face, part, leg, *closest});
    }
  });
}

/// The closest approach of a part and a face on a leg. If the budget is used up, it may be missing
/// or too far away. The face is then marked as unresolved.
std::optional<ClosestApproach> ClearanceFinder::measure(const ToolPart& part, const PartLeg& leg,
                                                        const OrganMotion& organ,
                                                        std::uint32_t face, double distance_bound) {
  const FaceMotion motion = organ.face(organ.after().faces()[face]);
  const std::uint64_t cuts = budget_.cuts();
  std::optional<ClosestApproach> closest;
  if (budget_.is_used_up()) {
    budget_.add_cut();
  } else if (part.is_surface()) {
    closest =
        closest_approach(*part.shape->surface, *leg.core.link(), motion, distance_bound, budget_);
  } else {
    closest = closest_approach(leg.core, motion, distance_bound, budget_);
  }
  if (budget_.cuts() != cuts && searches_each_face_) places_[face] = kUnresolved;
  return closest;
}

bool ClearanceFinder::is_searched(std::uint32_t face) const {
  return !searches_each_face_ || (places_[face] != kTouched && places_[face] != kUnresolved);
}

/// Keeps the nearest approach: of all faces, or of each face. Of faces at the same distance, the
/// one with the smallest number counts as the nearest.
void ClearanceFinder::add(const Approach& approach) {
  if (!searches_each_face_) {
    const bool is_tie = !found_.empty() && approach.distance == found_.front().distance;
    if (is_tie && approach.face > found_.front().face) return;
    found_.assign(1, approach);
    bound_ = approach.distance;
    return;
  }
  std::uint32_t& place = places_[approach.face];
  if (place == kUnresolved) return;
  if (place == kNothing) {
    place = static_cast<std::uint32_t>(found_.size());
    found_.push_back(approach);
  } else if (approach.distance < found_[place].distance) {
    found_[place] = approach;
  }
}

}  // namespace organ_collision
