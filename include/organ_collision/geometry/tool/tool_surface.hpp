#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/convex_core.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// A rigid triangle mesh of a tool, in its link's frame [m], with a tree of oriented boxes
/// (Gottschalk, Lin, Manocha: "OBBTree", 1996). Only its surface counts: a face of an organ that is
/// wholly inside of a closed tool mesh does not touch it.
class ToolSurface {
 public:
  /// Accepts any triangle soup. Throws MeshError if there is no face, an index is wrong, or a
  /// coordinate is not finite or beyond tolerance::kFarthest.
  ToolSurface(std::vector<Eigen::Vector3d> vertices, std::vector<FaceIndices> faces);

  /// The vertices that faces use. Their order is not that of the caller.
  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  /// The faces in the order of the tree, which does not depend on the caller's order of faces.
  const std::vector<FaceIndices>& faces() const { return faces_; }
  /// The corners of a face, counted in the order of faces().
  Triangle triangle(std::size_t face) const {
    return {vertices_[faces_[face][0]], vertices_[faces_[face][1]], vertices_[faces_[face][2]]};
  }

  /// The least and the greatest value of direction · vertex. `direction` need not be a unit vector.
  ProjectionInterval project_onto(const Eigen::Vector3d& direction) const;

  /// A box around the faces [begin, end). The two children of an inner node divide its faces. The
  /// first child is the next node of the list, and the second one is at the place `second`.
  struct Node {
    OrientedBox box;       ///< the box around the faces
    std::uint32_t begin;   ///< the first face
    std::uint32_t end;     ///< the place behind the last face
    std::uint32_t second;  ///< the place of the second child; 0 in a leaf
  };
  /// The nodes of the tree in depth-first order; the root is first.
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  void build(std::uint32_t begin, std::uint32_t end);
  void list_corners(std::uint32_t node, std::vector<Eigen::Vector3d>& corners);
  void extend(ProjectionInterval& interval, std::uint32_t node,
              const Eigen::Vector3d& direction) const;

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<FaceIndices> faces_;
  std::vector<Node> nodes_;
  /// The corners of a node's faces: rows [begin, end) of corners_. Each corner occurs once; the
  /// last one is repeated up to a multiple of eight rows. The list is empty for a node with many
  /// faces, and for all nodes below a node that has a list.
  struct CornerList {
    Eigen::Index begin = 0, end = 0;
  };
  std::vector<CornerList> corner_lists_;              ///< the list of each node
  Eigen::Matrix<double, Eigen::Dynamic, 3> corners_;  ///< columns x, y, z: fits vector registers
};

}  // namespace organ_collision
