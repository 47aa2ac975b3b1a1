#include "ros/publishing/markers/shown_markers.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;
using visualization_msgs::Marker;

TEST(ShownMarkers, DeletesWhatIsNoLongerThere) {
  ShownMarkers shown;
  visualization_msgs::MarkerArray array;
  shown.replace({{"names", {3, "liver"}}, {"tools", {1, "kidney"}}}, array);
  EXPECT_TRUE(array.markers.empty());
  shown.replace({{"names", {1, "spleen"}}}, array);
  ASSERT_EQ(array.markers.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(array.markers[i].action, Marker::DELETE);
  EXPECT_EQ(array.markers[0].ns, "names");
  EXPECT_EQ(array.markers[0].id, 1);
  EXPECT_EQ(array.markers[0].header.frame_id, "liver");
  EXPECT_EQ(array.markers[1].id, 2);
  EXPECT_EQ(array.markers[2].ns, "tools");
  EXPECT_EQ(array.markers[2].header.frame_id, "kidney");
}

TEST(ShownMarkers, DeletesNothingTwice) {
  ShownMarkers shown;
  visualization_msgs::MarkerArray array, again;
  shown.replace({{"names", {3, "liver"}}}, array);
  shown.replace({}, array);
  EXPECT_EQ(array.markers.size(), 3u);
  shown.replace({}, again);
  EXPECT_TRUE(again.markers.empty());
}

TEST(ShownMarkers, NothingIsDeletedAfterClear) {
  ShownMarkers shown;
  visualization_msgs::MarkerArray array;
  shown.replace({{"names", {3, "liver"}}}, array);
  shown.clear();
  shown.replace({}, array);
  EXPECT_TRUE(array.markers.empty());
}
