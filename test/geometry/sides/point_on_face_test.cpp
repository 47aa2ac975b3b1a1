#include "geometry/sides/point_on_face.hpp"

#include <gtest/gtest.h>

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

TEST(PointOnFace, DoesNotDependOnTheOrderOfCorners) {
  Random random(62);
  for (int trial = 0; trial < 5000; ++trial) {
    const auto [face, axis] = make_side_trial(random);
    const Triangle turned = {face[1], face[0], face[2]}, rotated = {face[2], face[0], face[1]};
    ASSERT_EQ(is_on_face(face, axis.trocar), is_on_face(turned, axis.trocar));
    ASSERT_EQ(is_on_face(face, axis.trocar), is_on_face(rotated, axis.trocar));
  }
}

TEST(PointOnFace, TheNextNumberIsOff) {
  const Triangle face = {Vector3d(0, 0, 1), Vector3d(1, 0, 1), Vector3d(0, 1, 1)};
  const Vector3d inside(0.25, 0.25, 1.0), on_edge(0.25, 0.75, 1.0);
  EXPECT_TRUE(is_on_face(face, inside));
  EXPECT_TRUE(is_on_face(face, on_edge));
  for (Eigen::Index i = 0; i < 3; ++i) {
    Vector3d next = on_edge;
    next[i] = std::nextafter(next[i], 2.0);
    EXPECT_FALSE(is_on_face(face, next)) << i;
  }
  Vector3d above = inside;
  above.z() = std::nextafter(1.0, 0.0);
  EXPECT_FALSE(is_on_face(face, above));
}

TEST(PointOnFace, SegmentsAndPoints) {
  const Vector3d a(0.5, 1.0, -2.0), b(1.5, 3.0, -4.0), middle(1.0, 2.0, -3.0);
  const Vector3d beyond(2.0, 4.0, -5.0), beside(1.0, 2.0, std::nextafter(-3.0, 0.0));
  EXPECT_TRUE(is_on_face({a, a, b}, middle));
  EXPECT_TRUE(is_on_face({a, middle, b}, middle));
  EXPECT_TRUE(is_on_face({b, a, middle}, a));
  EXPECT_FALSE(is_on_face({a, b, middle}, beyond));
  EXPECT_FALSE(is_on_face({a, b, b}, beside));
  EXPECT_TRUE(is_on_face({a, a, a}, a));
  EXPECT_FALSE(is_on_face({a, a, a}, b));
}

}  // namespace
}  // namespace organ_collision
