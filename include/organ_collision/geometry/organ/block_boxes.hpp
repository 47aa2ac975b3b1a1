#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

/// Axis-aligned boxes of an organ's blocks and sections of vertices, for one shape of it [m].
class BlockBoxes {
 public:
  /// Four coordinates, to be loaded at once; the fourth means nothing.
  struct Box {
    Eigen::Array4f min, max;
  };

  /// Fits the boxes to new vertices (x y z x y z ... [m]) in one pass over them. False if some
  /// coordinate is not finite: the boxes mean nothing then. Allocates only for new clusters.
  bool refit(const FaceClusters& clusters, const std::vector<float>& vertices);

  /// Both filled up to multiples of FaceClusters::kRun with boxes that hold nothing.
  const std::vector<Box>& blocks() const { return blocks_; }
  const std::vector<Box>& sections() const { return sections_; }
  /// Box around all vertices.
  const Eigen::AlignedBox3f& all() const { return all_; }

 private:
  std::vector<Box> blocks_, sections_;
  Eigen::AlignedBox3f all_;
};

}  // namespace organ_collision
