#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "test/picking/volumes/random_motions.hpp"

namespace organ_collision {

/// A face that the tool just touches at `touch`.
struct AimedFace {
  TriangleMesh mesh;
  Eigen::Vector3d touch;  // [m] on the face as it is after rounding to 32 bits
};

/// A face near `place` that extends only sideways and outward, so that it is touched at a corner,
/// on an edge or in its interior.
inline AimedFace aimed_face(const Eigen::Vector3d& place, const Eigen::Vector3d& outward,
                            double largest, Random& random) {
  const Eigen::Vector3d side = outward.cross(random.direction()).normalized();
  const double size = random.magnitude(1e-4, largest);
  const double lift = random.below(2) == 0 ? 0 : random.uniform(0, 1);
  const auto beyond = [&] {
    return Eigen::Vector3d(
        size * (Eigen::AngleAxisd(random.uniform(0, 7), outward) * side + lift * outward));
  };
  Eigen::Vector3d share(1, 0, 0);
  Triangle face = {place, place + beyond(), place + beyond()};
  if (lift == 0 && random.below(2) == 0) {
    const Eigen::Vector3d arm = beyond();
    face = {place - arm, place + 0.7 * arm, face[2]};
    share = Eigen::Vector3d(0.7, 1, 0) / 1.7;
  } else if (lift == 0) {
    const Eigen::Vector3d arm = beyond(), other = outward.cross(arm);
    face = {place - arm, place + arm + other, place + arm - other};
    share = Eigen::Vector3d(0.5, 0.25, 0.25);
  }
  const int turn = random.below(3);
  std::vector<float> vertices;
  for (int i = 0; i < 3; ++i) {
    for (const double value : face[static_cast<std::size_t>((i + turn) % 3)]) {
      vertices.push_back(static_cast<float>(value));
    }
  }
  const TriangleMesh mesh(vertices, {0, 1, 2});
  const Triangle rounded = mesh.triangle(0);
  Eigen::Vector3d touch = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) touch += share[(i + turn) % 3] * rounded[static_cast<std::size_t>(i)];
  return {mesh, touch};
}

/// A direction outward through a side, an edge or a corner of the volume, or a random direction.
inline Eigen::Vector3d aim(const ViewingVolume& volume, Random& random) {
  const int planes = random.below(8);
  if (planes == 0) return random.direction();
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  for (int i = 0; i < std::max(1, planes - 4); ++i) {
    const int index = random.below(static_cast<int>(volume.half_space_count()));
    outward += volume.half_space(static_cast<std::size_t>(index)).normal;
  }
  return outward.norm() < 0.1 ? random.direction() : Eigen::Vector3d(outward.normalized());
}

/// [m] The largest coordinate of the face relative to a volume's origin.
inline double extent(const TriangleMesh& mesh, const Eigen::Vector3d& origin) {
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    largest = std::max(largest, (mesh.vertex(k) - origin).cwiseAbs().maxCoeff());
  }
  return largest;
}

}  // namespace organ_collision
