#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

/// Axis-aligned boxes around the blocks and sections of an organ's vertices, for one shape of the
/// organ [m]. FaceClusters explains blocks and sections.
class BlockBoxes {
 public:
  /// The first three coordinates are x, y and z. The fourth is padding for vector registers.
  struct Box {
    Eigen::Array4f min;  ///< the smallest coordinates
    Eigen::Array4f max;  ///< the largest coordinates
  };

  /// Fits the boxes to new vertices (x y z x y z ... [m]) in one pass over them. Returns false if a
  /// coordinate is not finite; the boxes are then unspecified. Allocates only if `clusters` has
  /// more blocks than before.
  bool refit(const FaceClusters& clusters, const std::vector<float>& vertices);

  /// The boxes of the blocks, padded with empty boxes to a multiple of FaceClusters::kRun.
  const std::vector<Box>& blocks() const { return blocks_; }
  /// The boxes of the sections, padded in the same way.
  const std::vector<Box>& sections() const { return sections_; }
  /// The box around all vertices.
  const Eigen::AlignedBox3f& all() const { return all_; }

 private:
  std::vector<Box> blocks_, sections_;
  Eigen::AlignedBox3f all_;
};

}  // namespace organ_collision
