#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/projection_interval.hpp"
#include "organ_collision/geometry/tool/oriented_box.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// A rigid triangle mesh of a tool, in its link's frame [m], with a tree of oriented boxes
/// (Gottschalk, Lin, Manocha: "OBBTree", 1996). It is a surface: a face wholly inside a closed mesh
/// does not touch it.
class ToolSurface {
 public:
  /// Any triangle soup. Throws MeshError if there is no face, an index is wrong, or a coordinate is
  /// not finite or beyond tolerance::kFarthest.
  ToolSurface(std::vector<Eigen::Vector3d> vertices, std::vector<FaceIndices> faces);

  /// The vertices that faces use. Their order is not the caller's.
  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  /// In the order of the tree, which does not depend on the caller's order of faces.
  const std::vector<FaceIndices>& faces() const { return faces_; }
  /// The corners of a face, counted in the order of faces().
  Triangle triangle(std::size_t face) const {
    return {vertices_[faces_[face][0]], vertices_[faces_[face][1]], vertices_[faces_[face][2]]};
  }

  /// The least and the greatest direction · vertex. `direction` need not be unit.
  ProjectionInterval project_onto(const Eigen::Vector3d& direction) const;

  /// A box around the faces [begin, end). The two children of an inner node share its faces: the
  /// first child is the next node, the second one stands at `second`. In a leaf `second` is 0.
  struct Node {
    OrientedBox box;       ///< around the faces
    std::uint32_t begin;   ///< the first face
    std::uint32_t end;     ///< behind the last face
    std::uint32_t second;  ///< the node of the second child; 0 in a leaf
  };
  /// The tree in depth-first order; the root is first.
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  void build(std::uint32_t begin, std::uint32_t end);
  void list_corners(std::uint32_t node, std::vector<Eigen::Vector3d>& corners);
  void extend(ProjectionInterval& interval, std::uint32_t node,
              const Eigen::Vector3d& direction) const;

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<FaceIndices> faces_;
  std::vector<Node> nodes_;
  /// The corners of a node's faces: rows [begin, end) of corners_. Each corner is there once; the
  /// last one is repeated until the vector registers are full. Empty for a node with many faces,
  /// and for all nodes below a node that has a list.
  struct CornerList {
    Eigen::Index begin = 0, end = 0;
  };
  std::vector<CornerList> corner_lists_;              ///< of each node
  Eigen::Matrix<double, Eigen::Dynamic, 3> corners_;  ///< by coordinate, for vector registers
};

}  // namespace organ_collision
