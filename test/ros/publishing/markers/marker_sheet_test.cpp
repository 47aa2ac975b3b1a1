#include "ros/publishing/markers/marker_sheet.hpp"

#include <gtest/gtest.h>

#include "ros/publishing/markers/colours.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;

TEST(MarkerSheet, NumbersTheMarkersOfEachNamespace) {
  MarkerSheet sheet;
  for (const char* name : {"a", "b", "a", "a"}) {
    sheet.add(make_marker(name, "liver", Marker::CUBE, colours::tool()));
  }
  const auto& markers = sheet.markers().markers;
  ASSERT_EQ(markers.size(), 4u);
  EXPECT_EQ(markers[0].id, 0);
  EXPECT_EQ(markers[1].id, 0);
  EXPECT_EQ(markers[2].id, 1);
  EXPECT_EQ(markers[3].id, 2);
}

TEST(MarkerSheet, DropsEmptyLists) {
  MarkerSheet sheet;
  Marker list = make_marker("a", "liver", Marker::TRIANGLE_LIST, colours::tool());
  sheet.add(list);
  EXPECT_TRUE(sheet.markers().markers.empty());
  add_point(list, {0.5, 0.25, 2.0});
  sheet.add(list);
  ASSERT_EQ(sheet.markers().markers.size(), 1u);
  EXPECT_EQ(sheet.markers().markers[0].points[0].z, 2.0);
}

TEST(MarkerSheet, IsEmptyWhenItsMarkersAreTaken) {
  MarkerSheet sheet;
  sheet.add(make_marker("a", "liver", Marker::CUBE, colours::tool()));
  EXPECT_EQ(sheet.take().markers.size(), 1u);
  EXPECT_TRUE(sheet.markers().markers.empty());
}

TEST(MarkerSheet, MarkersFollowTheLatestTransformOfTheirFrame) {
  const Marker marker = make_marker("a", "liver", Marker::SPHERE, colours::tool());
  EXPECT_EQ(marker.header.frame_id, "liver");
  EXPECT_TRUE(marker.header.stamp.isZero());
  EXPECT_TRUE(marker.frame_locked);
  EXPECT_EQ(marker.pose.orientation.w, 1.0);
}
