#include "ros/publishing/markers/status_markers.hpp"

#include <gtest/gtest.h>

#include "ros/publishing/markers/colours.hpp"
#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;

TEST(StatusLine, CountsContactsAndGivesTheGreatestDepth) {
  EXPECT_EQ(status_line("hook", answer_with({})), "hook: touches nothing");
  EXPECT_EQ(status_line("hook", answer_with({contact_at(0, 0.0012, 0, 0)})),
            "hook: 1 contact, 1.2 mm deep");
  const auto two = answer_with({contact_at(0, -0.001, 0, 0), contact_at(1, 0.0349, 0, 0)});
  EXPECT_EQ(status_line("hook", two), "hook: 2 contacts, 34.9 mm deep");
}

TEST(StatusLine, TellsTheDistanceWhereNothingIsTouched) {
  const auto answer = answer_with({});
  answer->clearance.margin = 0.02;
  answer->clearance.state = Clearance::BEYOND_MARGIN;
  EXPECT_EQ(status_line("hook", answer), "hook: touches nothing, more than 20.0 mm away");
  answer->clearance.state = Clearance::KNOWN;
  answer->clearance.distance = 0.0032;
  EXPECT_EQ(status_line("hook", answer), "hook: touches nothing, 3.2 mm away");
  answer->contacts = {contact_at(0, 0.0012, 0, 0)};
  EXPECT_EQ(status_line("hook", answer), "hook: 1 contact, 1.2 mm deep");
}

TEST(StatusLine, TellsWhatIsInside) {
  const auto answer = answer_with({});
  answer->placement.tip = ToolPlacement::OUTSIDE;
  EXPECT_EQ(status_line("hook", answer), "hook: touches nothing");
  answer->placement.tip = ToolPlacement::ON_SURFACE;
  EXPECT_EQ(status_line("hook", answer), "hook: touches nothing, tip on the surface");
  answer->placement.tip = ToolPlacement::INSIDE;
  answer->placement.length_inside = 0.0321;
  EXPECT_EQ(status_line("hook", answer),
            "hook: touches nothing, tip inside, 32.1 mm of its axis inside");
}

TEST(StatusLine, SaysWhyThereIsNoAnswer) {
  const auto answer = answer_with({});
  answer->status = ContactArray::NO_TRANSFORM;
  answer->message = "frame 'hook_tip' is unknown";
  EXPECT_EQ(status_line("hook", answer), "hook: no transform: frame 'hook_tip' is unknown");
  EXPECT_EQ(status_line("hook", nullptr), "hook: no answer yet");
}

TEST(StatusMarkers, StandAboveTheOrgan) {
  Scene scene = hook_over_square();
  scene.organs.push_back(square("kidney"));
  scene.pairs[0].answer = answer_with({contact_at(0, 0.0012, 0, 0)});
  MarkerSheet sheet;
  add_status(scene, scene.organs[0], 42e-6, sheet);
  add_status(scene, scene.organs[1], 0.0, sheet);
  const auto& texts = sheet.markers().markers;
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_EQ(texts[0].text, "liver: 2 faces\nhook: 1 contact, 1.2 mm deep\n42 us a query");
  EXPECT_EQ(texts[0].header.frame_id, "liver_frame");
  EXPECT_EQ(texts[0].color, colours::text());
  EXPECT_DOUBLE_EQ(texts[0].pose.position.x, 0.5);
  EXPECT_GT(texts[0].pose.position.z, 0.0);
  EXPECT_EQ(texts[1].text, "kidney: 2 faces");
}

TEST(StatusMarkers, AreRedWithoutAnAnswer) {
  Scene scene = hook_over_square();
  const auto answer = answer_with({});
  answer->status = ContactArray::STALE_MESH;
  scene.pairs[0].answer = answer;
  MarkerSheet sheet;
  add_status(scene, scene.organs[0], 0.0, sheet);
  EXPECT_EQ(sheet.markers().markers.at(0).color, colours::failure());
}
