#include "ros/publishing/markers/crossing_markers.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using Eigen::Vector3d;
using visualization_msgs::Marker;

namespace {

const ShaftAxis kAxis{{0.3, 0.4, 1.0}, {0.9, 0.4, -0.2}};
constexpr double kRadius = 0.02;

Crossing crossing(double shaft, int direction) {
  Crossing crossing;
  crossing.shaft = shaft;
  crossing.point = tf2::toMsg(kAxis.at(shaft));
  crossing.direction = static_cast<std::int8_t>(direction);
  return crossing;
}

std::vector<Marker> markers(const std::vector<Crossing>& crossings) {
  ToolPlacement placement;
  placement.crossings = crossings;
  MarkerSheet sheet;
  add_crossings(square(), kAxis, kRadius, placement, sheet);
  return sheet.markers().markers;
}

/// The range of places on the axis of some points of a marker, relative to `from`, in metres.
std::pair<double, double> range(const Marker& marker, std::size_t first, std::size_t last,
                                const Vector3d& from) {
  const Vector3d along = (kAxis.tip - kAxis.trocar).normalized();
  std::pair<double, double> range{1.0, -1.0};
  for (std::size_t i = first; i < last; ++i) {
    const double place = (point(marker, i) - from).dot(along);
    range = {std::min(range.first, place), std::max(range.second, place)};
  }
  return range;
}

}  // namespace

TEST(CrossingMarkers, StandBeforeAnEntryAndBehindAnExit) {
  const Marker heads = markers({crossing(0.4, 1), crossing(0.7, -1)}).at(0);
  EXPECT_EQ(heads.ns, "crossings");
  const std::size_t half = heads.points.size() / 2;
  const auto entry = range(heads, 0, half, kAxis.at(0.4));
  EXPECT_NEAR(entry.second, 0.0, 1e-9);
  EXPECT_LT(entry.first, -kRadius);
  const auto exit = range(heads, half, 2 * half, kAxis.at(0.7));
  EXPECT_NEAR(exit.first, 0.0, 1e-9);
  EXPECT_GT(exit.second, kRadius);
  ASSERT_EQ(heads.colors.size(), heads.points.size());
  EXPECT_NE(heads.colors[0], heads.colors[half]);
}

TEST(CrossingMarkers, AreWiderThanTheShaft) {
  const Marker heads = markers({crossing(0.4, 1)}).at(0);
  const Vector3d along = (kAxis.tip - kAxis.trocar).normalized();
  double widest = 0.0;
  for (std::size_t i = 0; i < heads.points.size(); ++i) {
    widest = std::max(widest, (point(heads, i) - kAxis.trocar).cross(along).norm());
  }
  EXPECT_GT(widest, 1.5 * kRadius);
}

TEST(CrossingMarkers, NoneWithoutCrossingsAndNotTooMany) {
  EXPECT_TRUE(markers({}).empty());
  const std::size_t one = markers({crossing(0.4, 1)}).at(0).points.size();
  const std::vector<Crossing> many(kMostCrossings + 7, crossing(0.4, 1));
  EXPECT_EQ(markers(many).at(0).points.size(), kMostCrossings * one);
}
