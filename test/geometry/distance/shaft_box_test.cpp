#include "geometry/distance/shaft_box.hpp"

#include <gtest/gtest.h>

#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

void expect_contains(const OrientedBox& box, const Vector3d& point) {
  const Vector3d in_box = box.axes.transpose() * (point - box.center);
  const double slack = 1e-15 * (1.0 + point.norm());
  EXPECT_LE((in_box.cwiseAbs() - box.half_size).maxCoeff(), 100.0 * slack);
}

TEST(ShaftBox, ContainsEveryPositionOfTheAxis) {
  oracle::Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d away = random.chance(0.2) ? random.point(1e3) : random.point(0.1);
    const auto end = [&] { return Vector3d(away + random.scale(1e-6, 0.3) * random.direction()); };
    const ShaftMotion motion{{end(), end()}, {end(), end()}};
    const OrientedBox box = box_around(motion);
    EXPECT_LE((box.axes.transpose() * box.axes - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(box.axes.determinant(), 1.0, 1e-14);
    for (const double time : {0.0, 0.3, 0.5, 1.0}) {
      const ShaftAxis axis = motion.at(time);
      for (const double place : {0.0, 0.4, 1.0}) expect_contains(box, axis.at(place));
    }
  }
}

TEST(ShaftBox, OfAnAxisAtRestHasNoWidth) {
  oracle::Random random(2);
  for (int i = 0; i < 100; ++i) {
    const ShaftAxis axis{random.point(0.1), random.point(0.1)};
    const OrientedBox box = box_around({axis, axis});
    EXPECT_NEAR(box.half_size.x(), 0.5 * (axis.tip - axis.trocar).norm(), 1e-15);
    EXPECT_LE(box.half_size.tail<2>().maxCoeff(), 1e-16);
  }
}

TEST(ShaftBox, OfABallAndOfAMotionAlongTheAxisHasNoWidth) {
  const Vector3d trocar(0.03, -0.07, 0.11), tip(-0.02, 0.05, 0.01);
  EXPECT_EQ(box_around({{tip, tip}, {tip, tip}}).half_size.norm(), 0.0);
  const ShaftMotion along{{trocar, tip}, {trocar, ShaftAxis{trocar, tip}.at(1.7)}};
  EXPECT_LE(box_around(along).half_size.tail<2>().maxCoeff(), 1e-15);
}

}  // namespace
}  // namespace organ_collision
