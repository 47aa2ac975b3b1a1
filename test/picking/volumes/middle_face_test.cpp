#include "picking/volumes/middle_face.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "picking/volumes/box_volume.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "random_boxes.hpp"
#include "random_motions.hpp"

namespace organ_collision {
namespace {

/// [1] How far the middle of the face is inside all half-spaces, by the largest coordinate of the
/// face. Clipping in 32 bits loses about 5e-7 of that.
double depth_of_middle(const ViewingVolume& volume) {
  const Triangle face = middle_face(volume);
  const Eigen::Vector3d middle = 0.25 * face[0] + 0.25 * face[1] + 0.5 * face[2];
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    const HalfSpace half_space = volume.half_space(i);
    depth = std::min(depth, half_space.offset - half_space.normal.dot(middle));
  }
  return depth / largest_coordinate(face);
}

TEST(MiddleFace, MeetsEachVolumeOfShafts) {
  Random random(61);
  for (int i = 0; i < 60'000; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const ShaftMotion motion = random_motion(kind, i % 2 == 0 ? 0.3 : 200, random);
    const double radius = random.magnitude(1e-4, 0.02);
    ASSERT_GT(depth_of_middle(conservative_volume(motion, radius, {0.0, 1.0})), 1e-6) << motion;
  }
}

// Not the naive one, whose planes may cut off the middle of its box, and not those of a tool that
// moves along itself, which are slivers.
TEST(MiddleFace, MeetsThePapersVolumes) {
  Random random(62);
  for (int i = 0; i < 20'000; ++i) {
    ShaftMotion motion = random_motion(MotionKind::kSideways, 0.3, random);
    motion.end.trocar = motion.start.trocar;
    const double radius = random.magnitude(1e-4, 0.02);
    ASSERT_GT(depth_of_middle(paper_static_volume(motion.end, radius)), 1e-6) << motion << radius;
    ASSERT_GT(depth_of_middle(paper_swept_volume(motion, radius)), 1e-6) << motion << radius;
  }
}

TEST(MiddleFace, MeetsEachVolumeOfBoxes) {
  Random random(63);
  for (int i = 0; i < 20'000; ++i) {
    const MovingBox moving = random_box(0.3, random);
    const SweptBox swept(moving.box, moving.motion(), moving.radius);
    ASSERT_GT(depth_of_middle(conservative_volume(swept, {0.0, 1.0})), 1e-6) << moving;
  }
}

}  // namespace
}  // namespace organ_collision
