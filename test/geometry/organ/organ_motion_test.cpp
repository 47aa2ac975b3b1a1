#include "geometry/organ/organ_motion.hpp"

#include <gtest/gtest.h>

#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

const FaceMotion kMotion{
    {Vector3d(0.1, 0.2, 0.3), Vector3d(0.4, 0.1, -0.2), Vector3d(0.0, 0.3, 0.1)},
    {Vector3d(0.1, 0.2, 0.4), Vector3d(0.4, 0.4, -0.6), Vector3d(0.0, 0.3, 0.1)}};

TEST(FaceMotion, MovesItsCornersLinearly) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(kMotion.at(0.0)[i], kMotion.start[i]);
    EXPECT_TRUE(kMotion.at(1.0)[i].isApprox(kMotion.end[i], 1e-15));
    const Vector3d expected = 0.75 * kMotion.start[i] + 0.25 * kMotion.end[i];
    EXPECT_TRUE(kMotion.at(0.25)[i].isApprox(expected, 1e-15));
  }
}

TEST(FaceMotion, FarthestMoveIsThatOfOneCorner) { EXPECT_DOUBLE_EQ(kMotion.farthest_move(), 0.5); }

TEST(FaceMotion, LargestCoordinateIsThatOfBothEnds) {
  EXPECT_EQ(kMotion.largest_coordinate(), 0.6);
  EXPECT_EQ((FaceMotion{kMotion.end, kMotion.start}.largest_coordinate()), 0.6);
}

using oracle::Random;

std::vector<float> random_vertices(std::size_t count, Random& random) {
  std::vector<float> vertices;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    vertices.push_back(static_cast<float>(random.uniform(-0.3, 0.3)));
  }
  return vertices;
}

TEST(OrganMotion, AtRestFacesStayAndNothingElseIsLookedAt) {
  Random random(1);
  const TriangleMesh organ(random_vertices(3, random), {0, 1, 2});
  const OrganMotion motion(organ);
  EXPECT_TRUE(motion.rests());
  const FaceMotion face = motion.face({0, 1, 2});
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(face.start[i], organ.vertex(i));
    EXPECT_EQ(face.end[i], organ.vertex(i));
  }
}

TEST(OrganMotion, FacesMoveFromTheirPlaceAtBeginToThatAtFinish) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const TriangleMesh after(random_vertices(3, random), {0, 1, 2});
    TriangleMesh before = after;
    before.move_vertices(random_vertices(3, random));
    const double begin = trial % 4 == 0 ? 0.0 : random.uniform(0.0, 0.5);
    const double finish = trial % 3 == 0 ? 1.0 : random.uniform(0.5, 1.0);
    const OrganMotion motion(before, before.block_boxes(), after, begin, finish);
    EXPECT_FALSE(motion.rests());
    const FaceMotion face = motion.face({2, 0, 1});
    for (int i = 0; i < 3; ++i) {
      const std::size_t vertex = (i + 2) % 3;
      const Vector3d from = before.vertex(vertex), to = after.vertex(vertex);
      EXPECT_LE((face.start[i] - (from + begin * (to - from))).norm(), 1e-15);
      EXPECT_LE((face.end[i] - (from + finish * (to - from))).norm(), 1e-15);
      if (finish == 1.0) {
        EXPECT_EQ(face.end[i], to);
      }
    }
  }
}

TEST(OrganMotion, ExtentIsTheLargestCoordinateOfBothShapes) {
  const TriangleMesh after({0, 0, 0, 1, 0, 0, 0, 2, 0}, {0, 1, 2});
  TriangleMesh before = after;
  before.move_vertices(std::vector<float>{0, 0, -5, 1, 0, 0, 0, 2, 0});
  EXPECT_EQ(OrganMotion(after).extent({0.5, 0.5, 0.5}), 1.5);
  const OrganMotion motion(before, before.block_boxes(), after, 0.0, 1.0);
  EXPECT_EQ(motion.extent({0.5, 0.5, 0.5}), 5.5);
}

}  // namespace

}  // namespace organ_collision
