#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

/// Axis-aligned boxes [m] around the blocks of an organ's vertices, and around the faces of its
/// sections and larger groups, for one shape of the organ. FaceClusters explains these words.
class BlockBoxes {
 public:
  /// The first three coordinates are x, y and z. The fourth is padding for vector registers.
  struct Box {
    Eigen::Array4f min;  ///< the smallest coordinates
    Eigen::Array4f max;  ///< the largest coordinates

    /// The smallest box around both.
    Box join(const Box& other) const { return {min.min(other.min), max.max(other.max)}; }
  };

  /// Fits the boxes to new vertices (x y z x y z ... [m]) in one pass over them. Returns false if a
  /// coordinate is not finite; the boxes are then unspecified. Allocates only if `clusters` has
  /// more blocks than before.
  bool refit(const FaceClusters& clusters, const std::vector<float>& vertices);

  /// The boxes of the blocks, padded with empty boxes to a multiple of FaceClusters::kGroup.
  const std::vector<Box>& blocks() const { return blocks_; }
  /// The boxes around the vertices of a level's groups and of the faces of their clusters, padded
  /// in the same way. Level 0 is the sections.
  const std::vector<Box>& groups(std::size_t level) const { return groups_[level]; }
  /// The box around all vertices.
  const Eigen::AlignedBox3f& all() const { return all_; }

 private:
  void fit_groups(const FaceClusters& clusters);
  void add_borders(const FaceClusters& clusters);

  std::vector<Box> blocks_;
  std::vector<std::vector<Box>> groups_;  ///< by level; there may be levels of earlier clusters
  Eigen::AlignedBox3f all_;
};

}  // namespace organ_collision
