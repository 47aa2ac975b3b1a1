#include "nearest_faces.hpp"

#include <algorithm>
#include <tuple>

namespace organ_collision {

void NearestFaces::start(std::size_t face_count, std::size_t most, double bound) {
  for (const std::uint32_t face : placed_) places_[face] = kNothing;
  placed_.clear();
  if (places_.size() < face_count) places_.resize(face_count, kNothing);
  found_.clear();
  ranks_.clear();
  most_ = most;
  bound_ = bound;
}

void NearestFaces::exclude(std::uint32_t face) {
  if (places_[face] < kExcluded) remove(face);
  set_place(face, kExcluded);
}

/// Of approaches of one face at the same distance, the earlier one counts.
void NearestFaces::add(const Approach& approach) {
  const std::uint32_t place = places_[approach.face];
  if (place == kExcluded || approach.distance > bound_) return;
  if (place != kNothing) {
    Approach& known = found_[place];
    if (std::tie(approach.distance, approach.leg) >= std::tie(known.distance, known.leg)) return;
    known = approach;
    push(approach);
  } else {
    if (found_.size() == most_) {
      const Rank last = farthest();
      if (!(Rank(approach.distance, approach.face) < last)) return;
      remove(last.second);
    }
    set_place(approach.face, static_cast<std::uint32_t>(found_.size()));
    found_.push_back(approach);
    push(approach);
  }
  if (found_.size() == most_) bound_ = farthest().first;
}

const std::vector<Approach>& NearestFaces::sorted() {
  std::sort(found_.begin(), found_.end(), [](const Approach& a, const Approach& b) {
    return std::tie(a.distance, a.face) < std::tie(b.distance, b.face);
  });
  return found_;
}

void NearestFaces::push(const Approach& approach) {
  ranks_.emplace_back(approach.distance, approach.face);
  std::push_heap(ranks_.begin(), ranks_.end());
}

/// The rank of the farthest face in `found_`, which must not be empty.
NearestFaces::Rank NearestFaces::farthest() {
  const auto is_void = [&](const Rank& rank) {
    const std::uint32_t place = places_[rank.second];
    return place >= kExcluded || found_[place].distance != rank.first;
  };
  while (is_void(ranks_.front())) {
    std::pop_heap(ranks_.begin(), ranks_.end());
    ranks_.pop_back();
  }
  return ranks_.front();
}

void NearestFaces::remove(std::uint32_t face) {
  const std::uint32_t place = places_[face];
  places_[found_.back().face] = place;
  places_[face] = kNothing;
  found_[place] = found_.back();
  found_.pop_back();
}

void NearestFaces::set_place(std::uint32_t face, std::uint32_t place) {
  places_[face] = place;
  placed_.push_back(face);
}

}  // namespace organ_collision
