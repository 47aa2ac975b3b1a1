#include "ros/publishing/markers/surface_markers.hpp"

#include <gtest/gtest.h>

#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;

TEST(SurfaceMarkers, ShowEachFace) {
  const SceneOrgan organ = square();
  ASSERT_EQ(surface_marker_count(organ), 1u);
  const Marker surface = surface_marker(organ, 0, 0);
  EXPECT_EQ(surface.ns, "surface/liver");
  EXPECT_EQ(surface.header.frame_id, "liver_frame");
  EXPECT_EQ(surface.type, Marker::TRIANGLE_LIST);
  ASSERT_EQ(surface.points.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(point(surface, i), organ.triangle(i / 3)[i % 3]) << i;
  }
}

TEST(SurfaceMarkers, ALargeSurfaceIsCutIntoSeveral) {
  SceneOrgan organ = square();
  organ.faces =
      std::make_shared<std::vector<FaceIndices>>(2 * kFacesPerMarker + 5, FaceIndices{0, 1, 2});
  ASSERT_EQ(surface_marker_count(organ), 3u);
  EXPECT_EQ(surface_marker(organ, 0, 1).points.size(), 3 * kFacesPerMarker);
  EXPECT_EQ(surface_marker(organ, 0, 2).points.size(), 15u);
  EXPECT_EQ(surface_marker(organ, 0, 2).id, 2);
  organ.faces = std::make_shared<std::vector<FaceIndices>>(kFacesPerMarker, FaceIndices{0, 1, 2});
  EXPECT_EQ(surface_marker_count(organ), 1u);
}
