#include "picking/volumes/box_volume.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "excess.hpp"
#include "random_boxes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [m] The largest excess of a corner of a moving box at `time`.
double excess(const ViewingVolume& volume, const MovingBox& moving, double time) {
  const Eigen::Isometry3d pose = moving.motion().at(time);
  double largest = -std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d place(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Vector3d in_link =
        moving.box.center + moving.box.axes * place.cwiseProduct(moving.box.half_size);
    largest = std::max(largest, excess(volume, pose * in_link));
  }
  return largest;
}

TEST(ConservativeVolume, ContainsAMovingBox) {
  Random random(18);
  for (int i = 0; i < 20'000; ++i) {
    const MovingBox moving = random_box(i % 2 == 0 ? 0.3 : random.magnitude(1, 1000), random);
    VolumeMargin margin;
    if (i % 3 == 0) margin.motion = random.magnitude(1e-9, 0.01);
    if (i % 5 == 0) margin.extent = random.magnitude(0.1, 1000);
    const SweptBox swept(moving.box, moving.motion(), moving.radius);
    const ViewingVolume volume = conservative_volume(swept, margin);
    ASSERT_TRUE(volume.clip().allFinite()) << moving;
    EXPECT_EQ(volume.user_plane_count(), 0U);
    for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
      ASSERT_NEAR(volume.half_space(k).normal.norm(), 1, 1e-9) << moving;
    }
    for (int k = 0; k < 10; ++k) {
      const double out = excess(volume, moving, k < 2 ? k : random.uniform(0, 1));
      ASSERT_LE(out + moving.radius + margin.motion, -2.5e-7 * margin.extent + 1e-12) << moving;
    }
  }
}

TEST(ToolVolume, OfABoxIsTheBox) {
  Random random(19);
  for (int i = 0; i < 20'000; ++i) {
    MovingBox moving = random_box(0.3, random);
    const bool turns = moving.motion().angle() > 1e-8;
    const SweptBox swept(moving.box, moving.motion(), moving.radius);
    const ViewingVolume volume = tool_volume(swept);
    const double out = std::max(excess(volume, moving, 0), excess(volume, moving, 1));
    ASSERT_LE(out + moving.radius, 1e-12) << moving;
    if (turns) continue;
    EXPECT_NEAR(out + moving.radius, 0, 1e-12) << "its sides touch the box" << moving;
    for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
      const HalfSpace side = volume.half_space(k);
      const Vector3d along = swept.axes().transpose() * side.normal;
      EXPECT_NEAR(along.cwiseAbs().maxCoeff(), 1, 1e-12) << "along the box's own axes";
    }
  }
}

}  // namespace
}  // namespace organ_collision
