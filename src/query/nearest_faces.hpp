#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "moving_part.hpp"

namespace organ_collision {

/// The closest approach of a part of the tool and a face on one leg of a step.
struct Approach {
  double distance;  ///< [m] distance between the surfaces; see ToolClearance
  std::uint32_t face;
  ToolPart part;
  std::size_t leg;
  ClosestApproach closest;
};

/// Keeps the nearest faces of those that a search measures, each with its nearest approach. The
/// farthest of them bounds the search. Of faces at the same distance, those with smaller numbers
/// count as nearer. No work is proportional to the number of the organ's faces. Keeps its memory
/// between searches.
class NearestFaces {
 public:
  /// Begins a search among this many faces. At most `most` faces (at least 1) are kept, and only
  /// approaches up to `bound` [m].
  void start(std::size_t face_count, std::size_t most, double bound);

  /// From now on, no approach of this face is kept.
  void exclude(std::uint32_t face);
  bool is_excluded(std::uint32_t face) const { return places_[face] == kExcluded; }
  void add(const Approach& approach);

  /// [m] Only approaches up to this distance are still of interest.
  double bound() const { return bound_; }
  /// What is kept, in no order.
  const std::vector<Approach>& found() const { return found_; }
  /// Ends the search. Returns what is kept, the nearest face first.
  const std::vector<Approach>& sorted();

 private:
  // Values of places_.
  static constexpr std::uint32_t kNothing = 0xffffffff;
  static constexpr std::uint32_t kExcluded = kNothing - 1;

  /// The distance [m] of a face, and its number: the order of faces.
  using Rank = std::pair<double, std::uint32_t>;

  void push(const Approach& approach);
  Rank farthest();
  void remove(std::uint32_t face);
  void set_place(std::uint32_t face, std::uint32_t place);

  std::size_t most_ = 1;
  double bound_ = 0.0;
  std::vector<Approach> found_;
  /// A heap whose front is the farthest face in `found_`. A rank is void if its face is not in
  /// `found_` any more, or has come nearer.
  std::vector<Rank> ranks_;
  std::vector<std::uint32_t> places_;  ///< of each face in `found_`; kNothing or kExcluded
  std::vector<std::uint32_t> placed_;  ///< the faces whose places may not be kNothing
};

}  // namespace organ_collision
