#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "organ_collision/geometry/triangle_mesh.hpp"

namespace organ_collision {

/// One bit for each half-space that a vertex is outside of; for the vertices of the clusters that
/// were asked for, a block of vertices at a time. Keeps its memory.
class Outcodes {
 public:
  /// Starts anew. `half_spaces`, at most 16, have coordinates shifted so that `origin` is zero.
  void assign(const std::vector<HalfSpace>& half_spaces, const Eigen::Vector3d& origin,
              const TriangleMesh& mesh);

  /// Finds the outcodes of all vertices of the cluster's faces.
  void add_cluster(std::size_t cluster);

  /// Whether all corners of a face, of a cluster that was added, are outside of one half-space.
  bool is_outside(const FaceIndices& face) const {
    return (codes_[face[0]] & codes_[face[1]] & codes_[face[2]]) != 0;
  }

 private:
  struct Plane {
    float x, y, z, offset;
  };
  void add_block(std::uint32_t block);

  const TriangleMesh* mesh_ = nullptr;
  Eigen::Vector3d origin_;
  std::vector<Plane> planes_;
  std::vector<std::uint16_t> codes_;  ///< of vertices, in the sender's order
  std::vector<bool> block_is_done_;
};

}  // namespace organ_collision
