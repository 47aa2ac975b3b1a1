#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision::bench {

/// A surface, laid out as in a mesh message.
struct OrganSurface {
  std::vector<float> vertices;  ///< x y z x y z ... [m]
  std::vector<std::uint32_t>
      triangles;  ///< three vertex indices for each face, counter-clockwise seen from outside

  std::size_t face_count() const { return triangles.size() / 3; }
};

/// Corners [m] of a face when the organ's vertices are at `vertices`.
Triangle corners(const OrganSurface& organ, const std::vector<float>& vertices, std::size_t face);

/// With 4 faces, a tetrahedron. With 1224, 10 000, 100 000 or 1 000 000 faces, a closed organ of a
/// liver's size, 0.2 m by 0.13 m by 0.07 m, with its vertices ring by ring around the longest axis.
/// Throws std::invalid_argument for any other number.
OrganSurface make_organ(std::size_t faces);

/// The vertices of the deformed organ. Every vertex has a displacement of up to about 1 cm that is
/// the same in all phases. Around that position, each of its coordinates oscillates with
/// `amplitude` [m]. `phase` [rad].
std::vector<float> deformed(const std::vector<float>& rest, double phase, double amplitude);

/// A random order of vertices and faces: vertex i becomes `vertex[i]`, and face i becomes
/// `face[i]`.
struct Shuffle {
  Shuffle(const OrganSurface& organ, std::mt19937& random);
  OrganSurface apply(const OrganSurface& organ) const;
  std::vector<float> apply(const std::vector<float>& vertices) const;

  std::vector<std::uint32_t> vertex, face;
};

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
