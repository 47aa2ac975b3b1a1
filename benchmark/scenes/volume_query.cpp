#include "volume_query.hpp"

#include <algorithm>

#include "picking/volumes/conservative_volume.hpp"

namespace organ_collision::bench {
namespace {

double extent_from_trocar(const ShaftMotion& motion, const Eigen::AlignedBox3d& organ) {
  const Eigen::Vector3d low = organ.min() - motion.start.trocar;
  const Eigen::Vector3d high = organ.max() - motion.start.trocar;
  return std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
}

std::vector<HalfSpace> half_spaces_of(const ViewingVolume& volume) {
  std::vector<HalfSpace> half_spaces;
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    HalfSpace half_space = volume.half_space(i);
    half_space.offset += half_space.normal.dot(volume.origin());
    half_spaces.push_back(half_space);
  }
  return half_spaces;
}

}  // namespace

VolumeQuery::VolumeQuery(const ShaftMotion& motion, double radius, const Eigen::AlignedBox3d& organ)
    : motion(motion),
      radius(radius),
      extent(extent_from_trocar(motion, organ)),
      volume(conservative_volume(motion, radius, {0.0, extent})),
      half_spaces(half_spaces_of(volume)),
      solid(solid_of(half_spaces)),
      organ(organ) {}

}  // namespace organ_collision::bench
