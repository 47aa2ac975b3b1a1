#include "near_finder.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "contact_refiner.hpp"

namespace organ_collision {
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
