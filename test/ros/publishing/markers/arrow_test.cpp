#include "ros/publishing/markers/arrow.hpp"

#include <gtest/gtest.h>

#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

TEST(Arrow, IsAClosedSolidBetweenItsEnds) {
  const Vector3d tail(0.3, -0.2, 0.1), head(0.5, 0.4, -0.6);
  visualization_msgs::Marker list;
  add_arrow(tail, head, list);
  ASSERT_EQ(list.points.size() % 3, 0u);
  const Vector3d axis = (head - tail).normalized();
  double volume = 0.0, farthest = 0.0;
  for (std::size_t i = 0; i < list.points.size(); i += 3) {
    const Vector3d a = point(list, i), b = point(list, i + 1), c = point(list, i + 2);
    volume += (a - tail).dot((b - tail).cross(c - tail)) / 6.0;
    for (const Vector3d& corner : {a, b, c}) {
      const double along = axis.dot(corner - tail);
      EXPECT_GE(along, -1e-12);
      EXPECT_LE(along, (head - tail).norm() + 1e-12);
      farthest = std::max(farthest, along);
    }
  }
  EXPECT_GT(volume, 0.0);  // The faces point outward.
  EXPECT_NEAR(farthest, (head - tail).norm(), 1e-12);
}

TEST(Arrow, HasNoTrianglesWithoutLength) {
  visualization_msgs::Marker list;
  add_arrow(Vector3d::Ones(), Vector3d::Ones(), list);
  EXPECT_TRUE(list.points.empty());
}

TEST(ArrowHead, EndsAtItsApex) {
  const Vector3d base(0.3, -0.2, 0.1), apex(0.5, 0.4, -0.6);
  visualization_msgs::Marker list;
  add_arrow_head(base, apex, 0.05, list);
  const Vector3d axis = (apex - base).normalized();
  double farthest = 0.0, widest = 0.0;
  for (std::size_t i = 0; i < list.points.size(); ++i) {
    const double along = axis.dot(point(list, i) - base);
    EXPECT_GE(along, -1e-12);
    farthest = std::max(farthest, along);
    widest = std::max(widest, axis.cross(point(list, i) - base).norm());
  }
  EXPECT_NEAR(farthest, (apex - base).norm(), 1e-12);
  EXPECT_NEAR(widest, 0.05, 1e-12);
  visualization_msgs::Marker none;
  add_arrow_head(base, base, 0.05, none);
  EXPECT_TRUE(none.points.empty());
}
