#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/organ/organ_motion.hpp"
#include "organ_collision/geometry/tool/convex_core.hpp"

namespace organ_collision {

/// Visits the faces of an organ that may be near a box. It skips whole groups of faces, then
/// clusters (see FaceClusters), then single faces that are too far away. The nearest groups and
/// clusters come first, so a search for the nearest face soon has a small bound. See
/// doc/theory/geometry.md, Closest approach.
///
/// It computes in 32 bits and allows for the rounding: no face within the bound is skipped. Keeps
/// its memory between searches.
class FaceSearch {
 public:
  /// Calls measure(number) for each face that comes within bound() [m] of `box` while the organ
  /// moves, and for some other faces. `measure` may lower the value of bound() during the search,
  /// and ends the search if it returns false. Returns the number of faces that are then left: an
  /// upper bound of the number of faces within bound() that were not measured, with the last one.
  template <typename Bound, typename Measure>
  std::size_t visit(const OrganMotion& organ, const OrientedBox& box, Bound bound,
                    Measure measure) {
    return visit(
        organ, box, bound, [](const Box&) { return false; }, measure);
  }
  /// The same, but leaves out the faces in boxes for which skip(box) returns true. The boxes are
  /// those of groups and blocks, in the organ's frame.
  template <typename Bound, typename Skip, typename Measure>
  std::size_t visit(const OrganMotion& organ, const OrientedBox& box, Bound bound, Skip skip,
                    Measure measure) {
    start(organ, box);
    rank_groups(static_cast<std::uint32_t>(clusters().level_count()) - 1, 0, squared(bound()));
    while (const auto group = pop_nearest(groups_, squared(bound()))) {
      if (skip(box_around(*group))) continue;
      if (group->level > 0) {
        rank_groups(group->level - 1, group->index * FaceClusters::kGroup, squared(bound()));
        continue;
      }
      rank_blocks(group->index, squared(bound()));
      while (const auto block = pop_nearest(blocks_, squared(bound()))) {
        if (skip(box_around(block->index))) continue;
        place_vertices(block->index);
        const auto faces = clusters().faces(block->index);
        for (const FaceClusters::Face& face : faces) {
          if (!(squared_distance(face.corners) <= squared(bound()))) continue;
          if (measure(face.number)) continue;
          return static_cast<std::size_t>(faces.end() - &face) + faces_left(squared(bound()));
        }
      }
    }
    return 0;
  }

 private:
  using Box = BlockBoxes::Box;
  /// The smallest and largest coordinates [m] of a vertex during the motion, along the axes of the
  /// search's box and relative to the box's centre. The fourth values are zero.
  struct PlacedVertex {
    Eigen::Array4f low, high;
  };
  /// A group or a block, with a lower bound of the squared distance [m^2] from the search's box to
  /// the faces of its clusters.
  struct Ranked {
    float squared_distance;
    std::uint32_t index;
    std::uint32_t level;  ///< the level of the group; 0 for a block
  };
  /// The order of a heap whose front is the nearest group or block.
  static bool is_farther(const Ranked& a, const Ranked& b) {
    return a.squared_distance > b.squared_distance;
  }
  /// A heap of groups or blocks, the nearest one in front.
  using Ranking = std::vector<Ranked>;

  const FaceClusters& clusters() const { return organ_->after().clusters(); }
  void start(const OrganMotion& organ, const OrientedBox& box);
  void rank_groups(std::uint32_t level, std::size_t begin, float squared_bound);
  void rank_blocks(std::uint32_t section, float squared_bound);
  /// Finds the PlacedVertex of each vertex of the faces of the block's cluster, unless it is found
  /// already.
  void place_vertices(std::uint32_t block);
  static void push(const Ranked& ranked, float squared_bound, Ranking& ranking);
  /// Takes out the nearest group or block, unless it is beyond the bound.
  static std::optional<Ranked> pop_nearest(Ranking& ranking, float squared_bound);
  /// The number of faces of the ranked groups and blocks that are not beyond the bound.
  std::size_t faces_left(float squared_bound) const;

  /// [m^2] The square of a bound, with the allowance for rounding.
  float squared(double bound) const {
    constexpr double kMost = 1e18;  // [m] Its square does not overflow a 32-bit number.
    const auto grown = static_cast<float>(std::clamp(bound, 0.0, kMost) + slack_);
    return grown * grown;
  }
  // The functions below give lower bounds [m^2] without the allowance for rounding.
  float squared_distance(const Box& box) const;
  /// [m^2] A lower bound of the squared distance from the search's box to a face: the squared
  /// distance to the box around the face. Both boxes have parallel edges.
  float squared_distance(const FaceIndices& corners) const {
    const PlacedVertex &a = placed_[corners[0]], &b = placed_[corners[1]], &c = placed_[corners[2]];
    const Eigen::Array4f low = a.low.min(b.low).min(c.low);
    const Eigen::Array4f high = a.high.max(b.high).max(c.high);
    return (low.max(-high) - half_size_).max(0.0F).square().sum();
  }
  Box box_around(std::uint32_t block) const;
  Box box_around(const Ranked& group) const {
    const auto& after = organ_->after().block_boxes().groups(group.level);
    return after[group.index].join(organ_->boxes_before().groups(group.level)[group.index]);
  }

  std::optional<OrganMotion> organ_;
  // The search's box [m]. The fourth values are zero.
  Eigen::Array4f center_, half_size_;
  std::array<Eigen::Array4f, 3> rows_;  ///< rows of the matrix whose columns are the box's axes
  double slack_ = 0.0;                  ///< [m] the allowance for rounding
  Ranking groups_;                      ///< groups of all levels
  Ranking blocks_;                      ///< blocks of the present section
  std::vector<PlacedVertex> placed_;    ///< for each vertex of the mesh
  std::vector<char> block_is_placed_;
};

}  // namespace organ_collision
