#include "geometry/sides/face_crossing.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "side_trials.hpp"
#include "test/proof/exact_sides.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

TEST(PointOnFace, AgreesWithTheOracle) {
  Random random(61);
  int on = 0, off = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto [face, axis] = make_side_trial(random);
    for (const Vector3d& point : {axis.trocar, axis.tip, axis.at(0.5), face[trial % 3]}) {
      const bool expected = oracle::is_exactly_on(face, point);
      ASSERT_EQ(is_on_face(face, point), expected) << "trial " << trial;
      ++(expected ? on : off);
    }
  }
  EXPECT_GT(on, 20000);
  EXPECT_GT(off, 20000);
}

TEST(FaceCrossing, AgreesWithTheOracle) {
  Random random(71);
  int crossed = 0, missed = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto [face, axis] = make_side_trial(random);
    const auto expected = oracle::exact_crossings({face}, axis);
    const int direction = crossing_direction(face, axis);
    ASSERT_EQ(direction, expected.empty() ? 0 : expected[0].direction) << "trial " << trial;
    ++(direction != 0 ? crossed : missed);
    if (direction == 0) continue;
    const FaceCrossing crossing = face_crossing(face, axis);
    EXPECT_NEAR(crossing.shaft, expected[0].shaft, 1e-14) << "trial " << trial;
    EXPECT_LE((crossing.barycentric - expected[0].barycentric).norm(), 1e-14) << "trial " << trial;
    EXPECT_GE(crossing.barycentric.minCoeff(), 0.0);
    EXPECT_LE(crossing.barycentric.maxCoeff(), 1.0);
    EXPECT_NEAR(crossing.barycentric.sum(), 1.0, 1e-15);
    EXPECT_GE(crossing.shaft, 0.0);
    EXPECT_LE(crossing.shaft, 1.0);
    const double reach = std::max(largest_coordinate(face), (axis.tip - axis.trocar).norm());
    EXPECT_LE((point_at(face, crossing.barycentric) - axis.at(crossing.shaft)).norm(),
              1e-15 * reach * 4)
        << "trial " << trial;
  }
  EXPECT_GT(crossed, 3000);
  EXPECT_GT(missed, 3000);
}

/// Nothing but the shape counts, not even in the last digit.
TEST(FaceCrossing, TheOrderOfCornersChangesNothing) {
  Random random(72);
  for (int trial = 0; trial < 5000; ++trial) {
    const auto [face, axis] = make_side_trial(random);
    const int direction = crossing_direction(face, axis);
    const Triangle rotated = {face[1], face[2], face[0]}, turned = {face[2], face[1], face[0]};
    ASSERT_EQ(crossing_direction(rotated, axis), direction);
    ASSERT_EQ(crossing_direction(turned, axis), -direction);
    ASSERT_EQ(crossing_direction(face, {axis.tip, axis.trocar}), -direction);
    if (direction == 0) continue;
    const FaceCrossing one = face_crossing(face, axis);
    for (const Triangle& same : {rotated, turned}) {
      const FaceCrossing other = face_crossing(same, axis);
      ASSERT_EQ(other.shaft, one.shaft);
      ASSERT_EQ(other.shaft_rest, one.shaft_rest);
      ASSERT_EQ(crossing_shift(same, axis), crossing_shift(face, axis));
    }
    const Vector3d& bary = face_crossing(rotated, axis).barycentric;
    ASSERT_EQ(Vector3d(bary[2], bary[0], bary[1]), one.barycentric);
  }
}

/// One axis through a common edge of two faces, and through a common corner of a fan.
TEST(FaceCrossing, NeighboursShareTheirEdgesAndCorners) {
  Random random(74);
  for (int trial = 0; trial < 3000; ++trial) {
    const Vector3d hub = as_vertex(random.point(0.1));
    std::array<Vector3d, 5> rim;
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const double angle = 2 * M_PI * static_cast<double>(i) / 5;
      rim[i] = as_vertex(hub + Vector3d(0.02 * std::cos(angle), 0.02 * std::sin(angle),
                                        random.uniform(-0.002, 0.002)));
    }
    const Vector3d aim = trial % 2 == 0 ? hub : Vector3d(0.5 * (hub + rim[1]));
    ShaftAxis axis;
    axis.trocar =
        as_vertex(aim + Vector3d(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), 0.125));
    axis.tip = axis.trocar + 2.0 * (aim - axis.trocar);
    int sum = 0, crossed = 0;
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const int direction = crossing_direction({hub, rim[i], rim[(i + 1) % 5]}, axis);
      sum += direction;
      crossed += direction != 0;
    }
    ASSERT_EQ(sum, 1) << "trial " << trial;
    ASSERT_EQ(crossed % 2, 1);
  }
}

TEST(FaceCrossing, TheDirectionIsThatOfTheSurface) {
  const Triangle face = {Vector3d(-1, -1, 0), Vector3d(1, -1, 0),
                         Vector3d(0, 1, 0)};  // outward: +z
  EXPECT_EQ(crossing_direction(face, {{0.1, 0, 1}, {0.2, 0, -1}}), 1);
  EXPECT_EQ(crossing_direction(face, {{0.1, 0, -1}, {0.2, 0, 1}}), -1);
  EXPECT_EQ(crossing_direction(face, {{0.1, 0, 1}, {0.2, 0, 0.5}}), 0);
  EXPECT_EQ(crossing_direction(face, {{5, 0, 1}, {5, 0, -1}}), 0);
  EXPECT_EQ(crossing_direction(face, {{0.1, 0, 0}, {0.2, 0, 0}}), 0) << "in the plane";
  EXPECT_EQ(crossing_direction(face, {{0.1, 0, 0}, {0.1, 0, 0}}), 0) << "a ball";
  // An end on the face counts as moved by (e, e^2, e^3), which is to the outer side here.
  EXPECT_EQ(crossing_direction(face, {{0.1, 0, 0}, {0.2, 0, -1}}), 1);
  EXPECT_EQ(crossing_direction(face, {{0.1, 0, 0}, {0.2, 0, 1}}), 0);
}

}  // namespace
}  // namespace organ_collision
