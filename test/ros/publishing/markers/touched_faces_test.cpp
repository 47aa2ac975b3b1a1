#include "ros/publishing/markers/touched_faces.hpp"

#include <gtest/gtest.h>

#include "ros/publishing/markers/colours.hpp"
#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;

namespace {

Marker touched(TouchedFaces& faces, double now, const SceneOrgan& organ = square()) {
  Scene scene = hook_over_square(now);
  MarkerSheet sheet;
  faces.add_markers(scene, organ, sheet);
  return find_marker(sheet.markers(), "touched");
}

}  // namespace

TEST(TouchedFaces, AreDrawnOnBothSides) {
  const SceneOrgan organ = square();
  TouchedFaces faces;
  faces.add(organ, *answer_with({contact_at(1, 0.004, 0.7, 0.7)}), at(0.0));
  const Marker marker = touched(faces, 0.0, organ);
  ASSERT_EQ(marker.points.size(), 6u);
  EXPECT_EQ(marker.points[1].x, 1.0);
  EXPECT_EQ(marker.points[1].y, 1.0);
  EXPECT_GT(marker.points[1].z, 0.0);
  EXPECT_LT(marker.points[4].z, 0.0);
}

TEST(TouchedFaces, AreColouredByDepthAndFade) {
  const SceneOrgan organ = square();
  TouchedFaces faces;
  faces.add(organ, *answer_with({contact_at(1, 0.004, 0.7, 0.7)}), at(0.0));
  EXPECT_EQ(touched(faces, 0.0, organ).colors.at(0), colours::depth(0.4));  // of 10 mm
  const Marker later = touched(faces, 0.2, organ);
  EXPECT_LT(later.colors.at(0).a, 1.0f);
  EXPECT_GT(later.colors.at(0).a, 0.0f);
  EXPECT_EQ(touched(faces, 3.0, organ).type, -1);
  EXPECT_EQ(touched(faces, 0.0, organ).type, -1);  // It has been forgotten.
}

TEST(TouchedFaces, TheDeeperOfTwoToolsCounts) {
  const SceneOrgan organ = square();
  TouchedFaces faces;
  faces.add(organ, *answer_with({contact_at(0, 0.006, 0.1, 0.1)}), at(0.0));
  faces.add(organ, *answer_with({contact_at(0, 0.002, 0.1, 0.1)}), at(0.0));
  EXPECT_EQ(touched(faces, 0.0, organ).colors.at(0), colours::depth(0.6));
  faces.add(organ, *answer_with({contact_at(0, 0.002, 0.1, 0.1)}), at(0.1));
  EXPECT_EQ(touched(faces, 0.1, organ).colors.at(0), colours::depth(0.2));
}

TEST(TouchedFaces, OfEarlierTrianglesAreForgotten) {
  TouchedFaces faces;
  faces.add(square(), *answer_with({contact_at(1, 0.004, 0.7, 0.7)}), at(0.0));
  const SceneOrgan another = square();
  EXPECT_EQ(touched(faces, 0.0, another).type, -1);
  faces.add(another, *answer_with({contact_at(0, 0.004, 0.1, 0.1)}), at(0.0));
  EXPECT_EQ(touched(faces, 0.0, another).points.size(), 6u);
}

TEST(TouchedFaces, OfAnOrganThatIsGoneAreForgotten) {
  const SceneOrgan organ = square();
  TouchedFaces faces;
  faces.add(organ, *answer_with({contact_at(1, 0.004, 0.7, 0.7)}), at(0.0));
  faces.forget_others(Scene());
  EXPECT_EQ(touched(faces, 0.0, organ).type, -1);
}

TEST(Regions, AreClosedOutlines) {
  const auto answer = answer_with({});
  answer->regions.resize(2);
  answer->regions[1].points.resize(4);
  MarkerSheet sheet;
  add_regions(square(), *answer, sheet);
  EXPECT_EQ(find_marker(sheet.markers(), "regions").points.size(), 8u);
}
