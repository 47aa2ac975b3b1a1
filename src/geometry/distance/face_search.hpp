#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "organ_collision/geometry/tool/oriented_box.hpp"

namespace organ_collision {

/// Visits the faces of an organ that may be near a box. It leaves out whole groups, then clusters,
/// then single faces that are too far away. The nearest groups and clusters come first, so a search
/// for the nearest face soon has a small bound. See doc/geometry.md, Closest approach.
///
/// It computes in 32 bits and allows for their rounding: no face within the bound is left out.
/// Keeps its memory between searches.
class FaceSearch {
 public:
  /// Calls measure(number) for each face that may come within bound() [m] of `box` while the organ
  /// moves, and for some that do not. `measure` may lower what bound() returns: faces beyond it are
  /// then left out.
  template <typename Bound, typename Measure>
  void visit(const OrganMotion& organ, const OrientedBox& box, Bound bound, Measure measure) {
    start(organ, box);
    rank_top(squared(bound()));
    while (const auto group = pop_nearest(groups_, squared(bound()))) {
      if (group->level > 0) {
        rank_members(*group, squared(bound()));
        continue;
      }
      rank_blocks(group->index, squared(bound()));
      while (const auto block = pop_nearest(blocks_, squared(bound()))) {
        place_vertices(block->index);
        for (const FaceClusters::Face& face : clusters().faces(block->index)) {
          if (squared_distance(face.corners) <= squared(bound())) measure(face.number);
        }
      }
    }
  }

 private:
  using Box = BlockBoxes::Box;
  /// The coordinates of a vertex along the axes of the search's box, relative to its centre, as the
  /// smallest and largest values [m] during the motion. The fourth values are zero.
  struct PlacedVertex {
    Eigen::Array4f low, high;
  };
  /// A group or a block, with a lower bound of the squared distance [m^2] from the box to the faces
  /// of its clusters.
  struct Ranked {
    float squared_distance;
    std::uint32_t index;
    std::uint32_t level;  ///< of the group; 0 for a block
  };
  /// Orders a heap whose front is the nearest one.
  static bool is_farther(const Ranked& a, const Ranked& b) {
    return a.squared_distance > b.squared_distance;
  }
  /// Such a heap.
  using Ranking = std::vector<Ranked>;

  const FaceClusters& clusters() const { return organ_->after().clusters(); }
  void start(const OrganMotion& organ, const OrientedBox& box);
  void rank_top(float squared_bound);
  void rank_members(const Ranked& group, float squared_bound);
  void rank_groups(std::uint32_t level, std::size_t begin, float squared_bound);
  void rank_blocks(std::uint32_t section, float squared_bound);
  /// Places the vertices of the faces of the block's cluster, unless that is done.
  void place_vertices(std::uint32_t block);
  static void push(const Ranked& ranked, float squared_bound, Ranking& ranking);
  /// Takes out the nearest group or block, unless it is beyond the bound.
  static std::optional<Ranked> pop_nearest(Ranking& ranking, float squared_bound);

  /// [m^2] The square of a bound, with the allowance for rounding.
  float squared(double bound) const {
    constexpr double kMost = 1e18;  // [m] Its square is still a 32-bit number.
    const auto grown = static_cast<float>(std::clamp(bound, 0.0, kMost) + slack_);
    return grown * grown;
  }
  // Lower bounds [m^2] without that allowance.
  float squared_distance(const Box& box) const;
  /// [m^2] To the box around the face. The edges of that box are parallel to those of the search's
  /// box.
  float squared_distance(const FaceIndices& corners) const {
    const PlacedVertex &a = placed_[corners[0]], &b = placed_[corners[1]], &c = placed_[corners[2]];
    const Eigen::Array4f low = a.low.min(b.low).min(c.low);
    const Eigen::Array4f high = a.high.max(b.high).max(c.high);
    return (low.max(-high) - half_size_).max(0.0F).square().sum();
  }
  Box box_around(std::uint32_t block) const;

  std::optional<OrganMotion> organ_;
  // The box [m]. The fourth values are zero.
  Eigen::Array4f center_, half_size_;
  std::array<Eigen::Array4f, 3> rows_;  ///< of the matrix whose columns are the box's axes
  double slack_ = 0.0;                  ///< [m] the allowance for rounding
  Ranking groups_;                      ///< of all levels
  Ranking blocks_;                      ///< of the present section
  std::vector<PlacedVertex> placed_;    ///< by the vertex's index in the mesh
  std::vector<char> block_is_placed_;
};

}  // namespace organ_collision
