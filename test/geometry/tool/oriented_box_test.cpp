#include "organ_collision/geometry/tool/oriented_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

TEST(OrientedBox, SupportValueIsThatOfItsFarthestCorner) {
  oracle::Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Isometry3d pose = oracle::random_pose(0.3, random);
    const OrientedBox box{pose.translation(), pose.linear(),
                          Vector3d(random.uniform(0.0, 0.2), random.scale(1e-6, 0.2), 0.1)};
    const Vector3d direction = random.scale(1e-3, 1e3) * random.direction();
    double farthest = -INFINITY;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d signs(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0,
                           corner & 4 ? 1.0 : -1.0);
      farthest = std::max(farthest, direction.dot(pose * box.half_size.cwiseProduct(signs)));
    }
    EXPECT_NEAR(box.support_value(direction), farthest, 1e-15 * direction.norm());
  }
}

}  // namespace
}  // namespace organ_collision
