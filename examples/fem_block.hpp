#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// A block of soft tissue, 120 x 100 x 40 mm, simulated with the finite elements of Bullet:
/// tetrahedra of a corotated linear elastic material. Its bottom is held. Its top is at rest in the
/// plane z = 0, around the origin. Bullet's own collision detection is off: only push() acts.
class FemBlock {
 public:
  /// The block at rest.
  FemBlock();
  ~FemBlock();

  /// The faces of the closed surface, oriented outwards.
  const std::vector<FaceIndices>& faces() const { return faces_; }
  /// The places x y z x y z ... [m] of all nodes, also of those inside.
  std::vector<float> vertices() const;
  std::size_t vertex_count() const;

  /// What push() gave to nodes: the sum of the impulses [N s], and of their moments about the
  /// origin [N m s].
  struct Impulse {
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();
    Eigen::Vector3d angular = Eigen::Vector3d::Zero();
  };
  /// Adds the impulse force * seconds [N s] to a node. A node that is held takes none. Returns the
  /// impulse by which the momentum of Bullet's node has changed. Throws std::out_of_range if there
  /// is no such node.
  Impulse push(std::size_t node, const Eigen::Vector3d& force, double seconds);

  /// Simulates `seconds` (> 0).
  void step(double seconds);

 private:
  struct World;

  std::vector<FaceIndices> faces_;
  std::unique_ptr<World> world_;
};

}  // namespace organ_collision
