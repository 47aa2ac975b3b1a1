#include "query/paper_volume.hpp"

#include <gtest/gtest.h>

#include "picking/volumes/paper_volumes.hpp"

namespace organ_collision {
namespace {

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
