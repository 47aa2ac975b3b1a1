#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/oriented_box.hpp"

namespace organ_collision {

/// A rigid triangle mesh of a tool, in its link's frame, in a tree of oriented boxes that is made
/// once (Gottschalk, Lin, Manocha: "OBBTree", 1996). It is a surface: what lies wholly inside
/// touches nothing.
class ToolSurface {
 public:
  /// [m] Any triangle soup with at least one face. Throws MeshError for what could not be one:
  /// coordinates not finite or beyond tolerance::kFarthest, wrong indices, no face.
  ToolSurface(std::vector<Eigen::Vector3d> vertices, std::vector<FaceIndices> faces);

  /// Those that faces use.
  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  /// In the order of the tree, whatever the caller's is: triangles in another order make the same
  /// surface.
  const std::vector<FaceIndices>& faces() const { return faces_; }
  Triangle triangle(std::size_t face) const {
    return {vertices_[faces_[face][0]], vertices_[faces_[face][1]], vertices_[faces_[face][2]]};
  }

  /// How far it reaches along `direction`: the greatest direction · vertex.
  double height(const Eigen::Vector3d& direction) const;

  /// A box around the faces [begin, end), and around those of its two children, which follow it:
  /// the first directly, the second at `second`. A leaf has none: `second` is 0.
  struct Node {
    OrientedBox box;
    std::uint32_t begin, end;
    std::uint32_t second;
  };
  /// The first is the root.
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  void build(std::uint32_t begin, std::uint32_t end);
  void raise(std::uint32_t node, const Eigen::Vector3d& direction, double& height) const;

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<FaceIndices> faces_;
  std::vector<Node> nodes_;
};

}  // namespace organ_collision
