#include "query/contact_regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "link_scenes.hpp"
#include "picking/volumes/box_volume.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "scenes.hpp"
#include "test/proof/exact_distance.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

using ContactRegionsWith = CollisionQueryWith;

/// Whether a point is in the volume, to within the rounding of 32-bit clipping.
bool contains(const ViewingVolume& volume, const Vector3d& point) {
  for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
    const HalfSpace half_space = volume.half_space(k);
    if (half_space.normal.dot(point - volume.origin()) > half_space.offset + 2e-6) return false;
  }
  return true;
}

TEST_P(ContactRegionsWith, OfAShaftLieInTheFaceAndInTheToolVolume) {
  const TriangleMesh organ = mesh(liver());
  Random random(7);
  std::size_t filled = 0, all = 0;
  for (int i = 0; i < 20; ++i) {
    CollisionRequest request = swept(organ, random_path(false, random), 5e-3);
    request.path.resize(2);
    request.path[1].fraction = 1.0;
    request.regions = true;
    query_.evaluate(request, result_);
    ASSERT_EQ(result_.regions.size(), result_.contacts.size());
    const ViewingVolume volume = tool_volume({request.path[0].axis, request.path[1].axis}, 5e-3);
    for (std::size_t j = 0; j < result_.regions.size(); ++j) {
      ++all;
      filled += result_.regions[j].size() >= 3;
      const Triangle face = organ.triangle(result_.contacts[j].face);
      for (const Vector3d& corner : result_.regions[j]) {
        EXPECT_LE(oracle::distance({corner, corner, corner}, face), 1e-7);
        EXPECT_TRUE(contains(volume, corner));
      }
    }
    request.regions = false;
    query_.evaluate(request, result_);
    EXPECT_TRUE(result_.regions.empty());
  }
  EXPECT_GT(filled, all * 9 / 10);
}

TEST_P(ContactRegionsWith, OfALinkLieInTheFaceAndInAVolumeOfThatLink) {
  Random random(12);
  std::size_t filled = 0, all = 0;
  for (int i = 0; i < 40; ++i) {
    LinkScene scene(true, random);
    scene.request.radius = 0.0;
    scene.request.regions = true;
    scene.request.mode = QueryMode::kStatic;
    query_.evaluate(scene.request, result_);
    ASSERT_EQ(result_.regions.size(), result_.contacts.size());
    for (std::size_t j = 0; j < result_.regions.size(); ++j) {
      ++all;
      filled += result_.regions[j].size() >= 3;
      const FaceContact& contact = result_.contacts[j];
      const Triangle face = scene.organ.triangle(contact.face);
      const Isometry3d& pose = scene.request.path.back().links[contact.link];
      const RigidMotion rests(pose, pose);
      for (const Vector3d& corner : result_.regions[j]) {
        EXPECT_LE(oracle::distance(Triangle{corner, corner, corner}, face), 1e-7);
        const std::vector<LinkPart>& parts = scene.links[contact.link].parts;
        EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), [&](const LinkPart& part) {
          return contains(tool_volume(SweptBox(part.bounds, rests, part.radius)), corner);
        }));
      }
    }
  }
  EXPECT_GT(filled, all * 9 / 10);
  EXPECT_GT(all, 100U);
}

INSTANTIATE_TEST_SUITE_P(Pickers, ContactRegionsWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace
}  // namespace organ_collision
