#include "clearance_finder.hpp"

#include <algorithm>
#include <limits>

#include "contact_refiner.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
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

}  // namespace organ_collision
