#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// Says why vertices or triangles were refused. what() names the value and the legal range.
class MeshError : public std::invalid_argument {
 public:
  /// What was wrong.
  enum class Reason {
    kSize,            ///< an array has an illegal length, or another length than in the mesh so far
    kIndex,           ///< a triangle refers to a vertex that does not exist
    kNotFinite,       ///< a coordinate is NaN or infinite
    kTooFar,          ///< a coordinate is beyond tolerance::kFarthest
    kNoTriangles,     ///< there is no face
    kTooManyFaces,    ///< there are more faces than MeshLimits allow
    kTooManyVertices  ///< there are more than three vertices for each of the faces allowed
  };

  /// `message` is the text of what().
  MeshError(Reason reason, const std::string& message)
      : std::invalid_argument(message), reason_(reason) {}
  /// What was wrong.
  Reason reason() const { return reason_; }

 private:
  Reason reason_;
};

/// The size of the largest mesh that is accepted. A mesh may have up to three times as many
/// vertices as `max_faces`.
struct MeshLimits {
  /// The largest number of faces.
  std::size_t max_faces = 2'000'000;
};

/// Vertex positions, x y z x y z ... [m]. They are constant and shared, so that a mesh can use the
/// array of a message without a copy.
using SharedVertices = std::shared_ptr<const std::vector<float>>;

/// The triangles of a mesh. Copies of a mesh share them.
using SharedFaces = std::shared_ptr<const std::vector<FaceIndices>>;

/// The surface of an organ: triangles and the current positions of their vertices, in the organ's
/// frame [m]. Any triangle soup is accepted: the surface need not be closed or manifold, and faces
/// may be degenerate. A mesh is always valid: illegal input throws MeshError and changes nothing.
/// Copies share triangles and positions.
class TriangleMesh {
 public:
  /// `vertices`: at least one; coordinates finite and within tolerance::kFarthest. `triangles`:
  /// three vertex indices for each face; at least one face. `topology`: the number that the sender
  /// gives to this version of `triangles`.
  TriangleMesh(SharedVertices vertices, const std::vector<std::uint32_t>& triangles,
               std::uint32_t topology = 0, const MeshLimits& limits = {});
  /// \overload
  TriangleMesh(std::vector<float> vertices, const std::vector<std::uint32_t>& triangles,
               std::uint32_t topology = 0, const MeshLimits& limits = {})
      : TriangleMesh(std::make_shared<std::vector<float>>(std::move(vertices)), triangles, topology,
                     limits) {}

  /// Sets new positions for the same triangles. The number of vertices must be unchanged. Reads the
  /// positions once and does not copy them. Only the first call allocates memory.
  void move_vertices(SharedVertices vertices);
  /// \overload
  void move_vertices(std::vector<float> vertices) {
    move_vertices(std::make_shared<std::vector<float>>(std::move(vertices)));
  }

  /// The number of faces, at least one.
  std::size_t face_count() const { return faces().size(); }
  /// The number of vertices, at least one.
  std::size_t vertex_count() const { return vertices_->size() / 3; }
  /// The number that the sender gives to this version of the triangles.
  std::uint32_t topology() const { return topology_->revision; }

  /// All faces. The address is unchanged as long as the triangles are the same.
  const std::vector<FaceIndices>& faces() const { return topology_->faces; }
  /// All faces, for those who need them longer than the mesh exists.
  SharedFaces shared_faces() const { return {topology_, &topology_->faces}; }
  /// The faces, sorted into clusters of neighbours in space.
  const FaceClusters& clusters() const { return topology_->clusters; }
  /// The boxes [m] around the blocks and groups of clusters(), in the present shape.
  const BlockBoxes& block_boxes() const { return boxes_; }
  /// The positions of all vertices: x y z x y z ... [m]
  const std::vector<float>& vertices() const { return *vertices_; }
  /// The positions of all vertices, to be shared without a copy.
  const SharedVertices& shared_vertices() const { return vertices_; }
  /// The smallest axis-aligned box around all vertices [m].
  const Eigen::AlignedBox3f& box() const { return boxes_.all(); }

  /// The position of a vertex [m], with 0 <= index < vertex_count().
  Eigen::Vector3d vertex(std::size_t index) const {
    return Eigen::Map<const Eigen::Vector3f>(&(*vertices_)[3 * index]).cast<double>();
  }
  /// The corners of a face [m], with 0 <= face < face_count().
  Triangle triangle(std::size_t face) const { return triangle(faces()[face]); }
  /// The positions of three vertices [m].
  Triangle triangle(const FaceIndices& corners) const {
    return {vertex(corners[0]), vertex(corners[1]), vertex(corners[2])};
  }

  /// Whether both meshes have the same triangles and the same number of vertices. One mesh can then
  /// be an earlier shape of the other one.
  bool same_faces(const TriangleMesh& other) const {
    return vertex_count() == other.vertex_count() &&
           (topology_ == other.topology_ || faces() == other.faces());
  }
  /// Whether the faces are those of `triangles`, three vertex indices a face, in the same order.
  bool has_triangles(const std::vector<std::uint32_t>& triangles) const;

 private:
  /// What does not change with the shape. Copies of a mesh share it.
  struct Topology {
    std::uint32_t revision;
    std::vector<FaceIndices> faces;
    FaceClusters clusters;
  };
  std::shared_ptr<const Topology> topology_;
  SharedVertices vertices_;
  BlockBoxes boxes_;
  BlockBoxes spare_boxes_;  ///< boxes of new vertices, until these vertices are accepted
};

}  // namespace organ_collision
