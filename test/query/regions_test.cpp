#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "picking/volumes/conservative_volume.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "query/collision_query.hpp"
#include "query/request_check.hpp"
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

const ShaftMotion kMotion{{{0.01, 0.02, 0.2}, {0.03, -0.02, 0.01}},
                          {{0.01, 0.02, 0.2}, {0.05, 0.01, -0.02}}};
constexpr double kRadius = 0.005;

CollisionRequest request(QueryMode mode) {
  CollisionRequest request;
  request.path = {{0.0, kMotion.start}, {1.0, kMotion.end}};
  request.radius = kRadius;
  request.mode = mode;
  return request;
}

void expect_same(const ViewingVolume& volume, const ViewingVolume& right) {
  EXPECT_EQ(volume.origin(), right.origin());
  EXPECT_EQ(volume.clip(), right.clip());
  ASSERT_EQ(volume.user_plane_count(), right.user_plane_count());
  for (std::size_t i = 0; i < right.user_plane_count(); ++i) {
    EXPECT_EQ(volume.user_planes()[i], right.user_planes()[i]);
  }
}

TEST(PaperVolume, is_that_of_the_mode) {
  expect_same(paper_volume(request(QueryMode::kPaperStatic)),
              paper_static_volume(kMotion.end, kRadius));
  expect_same(paper_volume(request(QueryMode::kPaperSwept)), paper_swept_volume(kMotion, kRadius));
  expect_same(paper_volume(request(QueryMode::kPaperNaive)), paper_naive_volume(kMotion, kRadius));
}

TEST(PaperVolume, needs_only_the_last_waypoint_in_the_static_mode) {
  CollisionRequest last = request(QueryMode::kPaperStatic);
  last.path = {{1.0, kMotion.end}};
  expect_same(paper_volume(last), paper_static_volume(kMotion.end, kRadius));
}

TEST(PaperVolume, refuses_a_shaft_without_length) {
  CollisionRequest ball = request(QueryMode::kPaperSwept);
  for (ToolWaypoint& waypoint : ball.path) waypoint.axis.tip = waypoint.axis.trocar;
  EXPECT_THROW(paper_volume(ball), VolumeError);
}

}  // namespace

}  // namespace organ_collision
