#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "organ_collision/geometry/face_clusters.hpp"
#include "organ_collision/geometry/half_space.hpp"

namespace organ_collision {

/// Axis-aligned boxes of clusters for one shape of an organ [m].
class ClusterBoxes {
 public:
  /// Fits the boxes to new vertices (x y z x y z ... [m]) in one pass over them. False if some
  /// coordinate is not finite: the boxes mean nothing then. Allocates only for new clusters.
  bool refit(const FaceClusters& clusters, const std::vector<float>& vertices);

  /// Box around all vertices.
  const Eigen::AlignedBox3f& all() const { return all_; }

  /// Replaces `clusters` by those whose boxes may meet the intersection of `half_spaces`, whose
  /// coordinates are shifted so that `origin` is zero. Rounding never loses one.
  void find_meeting(const std::vector<HalfSpace>& half_spaces, const Eigen::Vector3d& origin,
                    std::vector<std::uint32_t>& clusters) const;

  /// Box of one cluster.
  Eigen::AlignedBox3f box(std::size_t cluster) const;

 private:
  bool fit_blocks(const FaceClusters& clusters, const std::vector<float>& vertices);
  void fit_clusters(const FaceClusters& clusters);

  std::vector<Eigen::Array4f> block_min_, block_max_;  // the fourth is padding
  std::array<std::vector<float>, 3> min_, max_;        // of clusters, one array for each axis
  Eigen::AlignedBox3f all_;
};

}  // namespace organ_collision
