#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

/// Axis-aligned boxes [m] around the blocks of an organ's vertices, and around the faces of its
/// sections and larger groups, for one shape of the organ. FaceClusters explains these words.
class BlockBoxes {
 public:
  /// A box with the coordinates x, y, z and a fourth one that only fills the vector register.
  struct Box {
    Eigen::Array4f min;  ///< the smallest coordinates
    Eigen::Array4f max;  ///< the largest coordinates

    /// The smallest box around this box and the other one.
    Box join(const Box& other) const { return {min.min(other.min), max.max(other.max)}; }
  };

  /// Fits the boxes to new vertices (x y z x y z ... [m]) in one pass over them. Returns false if a
  /// coordinate is not finite; the boxes are then unspecified. Allocates memory only if `clusters`
  /// has more blocks than the clusters of an earlier call.
  bool refit(const FaceClusters& clusters, const std::vector<float>& vertices);

  /// The boxes of the blocks, with empty boxes up to a multiple of FaceClusters::kGroup.
  const std::vector<Box>& blocks() const { return blocks_; }
  /// The boxes of the groups of a level. Each contains the blocks of its group and all faces of
  /// their clusters. Empty boxes follow as for blocks(). The groups of level 0 are the sections.
  const std::vector<Box>& groups(std::size_t level) const { return groups_[level]; }
  /// The box around all vertices.
  const Eigen::AlignedBox3f& all() const { return all_; }

 private:
  void fit_groups(const FaceClusters& clusters);
  void add_borders(const FaceClusters& clusters);

  std::vector<Box> blocks_;
  std::vector<std::vector<Box>> groups_;  ///< by level; may have more levels than the clusters
  Eigen::AlignedBox3f all_;
};

}  // namespace organ_collision
