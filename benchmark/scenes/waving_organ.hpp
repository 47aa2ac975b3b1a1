#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_surface.hpp"

namespace organ_collision::bench {

/// An organ whose vertices oscillate smoothly, so that it has a new shape at each tick of 1 ms.
/// Each coordinate of a vertex moves by up to 2 mm to either side at 10 Hz: at up to 0.13 m/s.
class WavingOrgan {
 public:
  static constexpr std::size_t kPeriod = 100;  ///< [ticks]

  /// `faces`: as for make_organ().
  explicit WavingOrgan(std::size_t faces);

  /// The organ halfway between its extreme shapes.
  const OrganSurface& middle() const { return middle_; }
  /// x y z x y z ... [m] at a tick.
  SharedVertices shape(std::size_t tick) const;

 private:
  OrganSurface middle_;
  Eigen::VectorXf cosine_, sine_;  ///< [m] displacements at the start and at a quarter of a period
};

}  // namespace organ_collision::bench
