#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "organ_collision/geometry/organ/block_boxes.hpp"
#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

/// Corners of one face, in its order [m].
using Triangle = std::array<Eigen::Vector3d, 3>;

/// Why vertices or triangles were refused. what() names the value and what is legal.
class MeshError : public std::invalid_argument {
 public:
  enum class Reason {
    kSize,
    kIndex,
    kNotFinite,
    kTooFar,
    kNoTriangles,
    kTooManyFaces,
    kTooManyVertices
  };

  MeshError(Reason reason, const std::string& message)
      : std::invalid_argument(message), reason_(reason) {}
  Reason reason() const { return reason_; }

 private:
  Reason reason_;
};

/// The most that a mesh may hold; vertices may be three for each face and no more.
struct MeshLimits {
  std::size_t max_faces = 2'000'000;
};

/// Vertex positions, x y z x y z ... [m], that never change while they are shared: a message's own
/// array can be an organ's shape without a copy.
using SharedVertices = std::shared_ptr<const std::vector<float>>;

/// The surface of an organ: triangles, and where their vertices are now, in the organ's frame.
/// Any triangle soup: no closed or manifold surface is needed; degenerate faces are allowed.
/// Always valid: whatever could break it throws MeshError and changes nothing.
/// Copies share triangles and positions.
class TriangleMesh {
 public:
  /// `vertices`: 32-bit floats, finite, within tolerance::kFarthest, at least one vertex.
  /// `triangles`: three indices a face, at least one face.
  /// `topology`: the sender's revision of `triangles`.
  TriangleMesh(SharedVertices vertices, const std::vector<std::uint32_t>& triangles,
               std::uint32_t topology = 0, const MeshLimits& limits = {});
  TriangleMesh(std::vector<float> vertices, const std::vector<std::uint32_t>& triangles,
               std::uint32_t topology = 0, const MeshLimits& limits = {})
      : TriangleMesh(std::make_shared<std::vector<float>>(std::move(vertices)), triangles, topology,
                     limits) {}

  /// New positions for the same triangles, as many as there are; read once, neither copied nor
  /// anything allocated.
  void move_vertices(SharedVertices vertices);
  void move_vertices(std::vector<float> vertices) {
    move_vertices(std::make_shared<std::vector<float>>(std::move(vertices)));
  }

  std::size_t face_count() const { return faces().size(); }
  std::size_t vertex_count() const { return vertices_->size() / 3; }
  std::uint32_t topology() const { return topology_->revision; }

  /// All faces; the same address for as long as the triangles are the same.
  const std::vector<FaceIndices>& faces() const { return topology_->faces; }
  /// The same faces in spatially coherent groups, and the boxes of their vertices now.
  const FaceClusters& clusters() const { return topology_->clusters; }
  const BlockBoxes& block_boxes() const { return boxes_; }
  /// x y z x y z ... [m]
  const std::vector<float>& vertices() const { return *vertices_; }
  const SharedVertices& shared_vertices() const { return vertices_; }
  /// Smallest axis-aligned box around all vertices [m].
  const Eigen::AlignedBox3f& box() const { return boxes_.all(); }

  Eigen::Vector3d vertex(std::size_t index) const {
    return Eigen::Map<const Eigen::Vector3f>(&(*vertices_)[3 * index]).cast<double>();
  }
  Triangle triangle(std::size_t face) const { return triangle(faces()[face]); }
  Triangle triangle(const FaceIndices& corners) const {
    return {vertex(corners[0]), vertex(corners[1]), vertex(corners[2])};
  }

  /// Whether both have the same triangles and as many vertices, so that one can be the other's
  /// earlier shape.
  bool same_faces(const TriangleMesh& other) const {
    return vertex_count() == other.vertex_count() &&
           (topology_ == other.topology_ || faces() == other.faces());
  }
  /// Whether the faces are those of `triangles`, three vertex indices a face, in the same order.
  bool has_triangles(const std::vector<std::uint32_t>& triangles) const;

 private:
  /// What never changes, shared by all shapes.
  struct Topology {
    std::uint32_t revision;
    std::vector<FaceIndices> faces;
    FaceClusters clusters;
  };
  std::shared_ptr<const Topology> topology_;
  SharedVertices vertices_;
  BlockBoxes boxes_;
  BlockBoxes spare_boxes_;  ///< new vertices are looked at here before they are accepted
};

}  // namespace organ_collision
