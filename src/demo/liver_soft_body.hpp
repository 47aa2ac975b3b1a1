#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "liver_surface.hpp"

class btSoftBody;
struct btSoftBodyWorldInfo;

namespace organ_collision {

/// Where a tool presses on a face, and how far that place should give way.
struct Push {
  std::uint32_t face;
  Eigen::Vector3d barycentric;   ///< of the place in the face
  Eigen::Vector3d displacement;  ///< [m]
};

/// A liver of soft tissue (Bullet's soft body): keeps its volume, returns to its shape, and moves
/// to and fro with the breath, to which it is tied by the ligaments at its back.
class LiverSoftBody {
 public:
  /// At rest, breathed out. `surface` is closed [m].
  explicit LiverSoftBody(const Surface& surface);
  ~LiverSoftBody();

  /// Moves on by `seconds` (> 0), giving way to `pushes` first. Where several meet in one vertex,
  /// their mean counts.
  void step(double seconds, const std::vector<Push>& pushes);

  /// x y z x y z ... [m], in the order of the surface.
  std::vector<float> vertices() const;

 private:
  void give_way(const std::vector<Push>& pushes);
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
