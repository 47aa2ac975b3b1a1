#include "geometry/coordinate_range.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(CoordinateRange, EndsAtTheFarthest) {
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_TRUE(is_in_range(sign * tolerance::kFarthest));
    EXPECT_FALSE(is_in_range(sign * 1.000001 * tolerance::kFarthest));
    EXPECT_FALSE(is_in_range(sign * kInfinity));
  }
  EXPECT_FALSE(is_in_range(kNan));
}

TEST(CoordinateRange, OfAPointCountsEveryCoordinate) {
  EXPECT_TRUE(is_in_range(Vector3d(0.0, -tolerance::kFarthest, tolerance::kFarthest)));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double bad : {kNan, kInfinity, -2.0 * tolerance::kFarthest}) {
      Vector3d point(0.1, 0.2, 0.3);
      point[axis] = bad;
      EXPECT_FALSE(is_in_range(point));
    }
  }
}

}  // namespace
}  // namespace organ_collision
