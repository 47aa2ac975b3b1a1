#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// A closed surface whose faces are oriented outwards. Positions in metres.
struct ClosedSurface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<FaceIndices> faces;

  Triangle triangle(std::size_t face) const {
    const FaceIndices& f = faces[face];
    return {vertices[f[0]], vertices[f[1]], vertices[f[2]]};
  }
};

/// [m] Approximate signed distance to the surface of the liver, negative inside.
/// x points to the patient's left, y to the head, z to the front. The right lobe is the larger one.
double liver_level(const Eigen::Vector3d& point);

/// The liver's surface at rest: 614 vertices, 1224 faces, 0.2 m from lobe to lobe. It begins as the
/// surface of a box of 19 x 10 x 4 cells, with 2 triangles for each square. The vertices are moved
/// onto liver_level = 0 and spread evenly there.
ClosedSurface make_liver_surface();

}  // namespace organ_collision

class btSoftBody;
struct btSoftBodyWorldInfo;

namespace organ_collision {

/// A place where a tool presses on a face, and how far the tissue yields there.
struct TissuePush {
  std::uint32_t face;
  Eigen::Vector3d barycentric;   ///< of the place in the face
  Eigen::Vector3d displacement;  ///< [m]
};

/// How far a vertex yields.
struct VertexPush {
  std::uint32_t vertex;
  Eigen::Vector3d displacement;  ///< [m]
};

/// A liver of soft tissue, simulated as a soft body of Bullet. It keeps its volume and returns to
/// its shape. The ligaments at its back move it with the breath.
class LiverSoftBody {
 public:
  /// At rest, exhaled.
  explicit LiverSoftBody(const ClosedSurface& surface);
  ~LiverSoftBody();

  /// Applies the pushes, then simulates `seconds` (> 0). A vertex that several pushes move is
  /// displaced by their mean.
  void step(double seconds, const std::vector<TissuePush>& pushes,
            const std::vector<VertexPush>& vertex_pushes = {});

  /// x y z x y z ... [m], in the order of the surface.
  std::vector<float> vertices() const;

 private:
  void give_way(const std::vector<TissuePush>& pushes,
                const std::vector<VertexPush>& vertex_pushes);
  void breathe();

  struct Ligament {
    int node;
    Eigen::Vector3d rest;  ///< [m]
  };
  std::unique_ptr<btSoftBodyWorldInfo> world_;
  std::unique_ptr<btSoftBody> body_;
  std::vector<Ligament> ligaments_;
  double time_ = 0.0;  ///< [s]
};

}  // namespace organ_collision
