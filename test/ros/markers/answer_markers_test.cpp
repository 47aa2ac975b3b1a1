#include "ros/markers/answer_markers.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <utility>

#include "ros/messages/conversions.hpp"
#include "test/ros/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

MarkerArray contacts_of(const ContactArray& answer, double share = 1.0) {
  MarkerArray picture;
  add_contacts(square(), answer, share, picture);
  return picture;
}

MarkerArray surroundings_of(const ContactArray& answer) {
  MarkerArray picture;
  add_surroundings(square(), answer, picture);
  return picture;
}

/// The hook is 32 mm from the square, along an oblique line.
ContactArrayPtr answer_near() {
  const auto answer = answer_with({});
  Clearance& clearance = answer->clearance;
  clearance.state = Clearance::KNOWN;
  clearance.margin = 0.05;
  clearance.distance = 0.032;
  const Vector3d normal(0.6, 0.0, -0.8), on_organ(0.25, 0.5, 0.0);
  clearance.normal = to_vector(normal);
  clearance.on_organ = tf2::toMsg(on_organ);
  clearance.on_tool = tf2::toMsg(Vector3d(on_organ - 0.032 * normal));
  return answer;
}

const ShaftAxis kAxis{{0.3, 0.4, 1.0}, {0.9, 0.4, -0.2}};

Crossing crossing(double shaft, int direction) {
  Crossing crossing;
  crossing.shaft = shaft;
  crossing.point = tf2::toMsg(kAxis.at(shaft));
  crossing.direction = static_cast<std::int8_t>(direction);
  return crossing;
}

std::vector<Marker> cones_of(const std::vector<Crossing>& crossings) {
  ToolPlacement placement;
  placement.crossings = crossings;
  MarkerArray picture;
  add_crossings(square(), kAxis, 0.02, placement, picture);
  return find_markers(picture, "crossings");
}

}  // namespace

TEST(ContactMarkers, RegionsAreClosedOutlines) {
  const auto answer = answer_with({});
  answer->regions.resize(2);
  answer->regions[1].points.resize(4);
  EXPECT_EQ(find_markers(contacts_of(*answer), "regions").at(0).points.size(), 8u);
}

TEST(ContactMarkers, NormalsEndAtTheContactFromTheSideOfTheTool) {
  const auto answer = answer_with({contact_at(0, 0.1, 0.25, 0.5)});
  const Marker arrow = find_markers(contacts_of(*answer, 0.25), "normals").at(0);
  EXPECT_EQ(point(arrow, 1), Vector3d(0.25, 0.5, 0.0));
  EXPECT_TRUE(point(arrow, 0).isApprox(Vector3d(0.25, 0.5, 0.07 * square().size()), 1e-9));
  EXPECT_NEAR(arrow.color.a, 0.25, 1e-6);
  EXPECT_TRUE(contacts_of(*answer_with({})).markers.empty());
}

TEST(ContactMarkers, OnlyTheDeepestContactsHaveArrows) {
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < kMostArrows; ++i) {
    contacts.push_back(contact_at(0, -0.1, 8.0, 0.0));
    contacts.push_back(contact_at(0, 0.1, 0.5, 0.0));
  }
  const auto arrows = find_markers(contacts_of(*answer_with(contacts)), "normals");
  ASSERT_EQ(arrows.size(), kMostArrows);
  for (const Marker& arrow : arrows) EXPECT_EQ(point(arrow, 1).x(), 0.5);
}

TEST(ContactMarkers, EachTouchingLinkHasANameAtItsDeepestContact) {
  auto contacts = std::vector<Contact>{contact_at(0, 0.1, 0.1, 0.0), contact_at(1, 0.3, 0.2, 0.0),
                                       contact_at(1, 0.2, 0.3, 0.0)};
  contacts[2].link = 2;
  const auto answer = answer_with(contacts);
  answer->links = {"", "wrist", "jaw"};
  const auto names = find_markers(contacts_of(*answer), "names");
  ASSERT_EQ(names.size(), 2u);
  EXPECT_EQ(names[0].type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(names[0].text, "hook");  // The shaft has no name of its own.
  EXPECT_DOUBLE_EQ(names[0].pose.position.x, 0.2);
  EXPECT_GT(names[0].pose.position.z, 0.0);
  EXPECT_EQ(names[1].text, "jaw");
  EXPECT_EQ(names[1].id, 1);
}

TEST(ClearanceMarkers, ALineFromToolToOrganAndItsLength) {
  const auto answer = answer_near();
  auto shown = find_markers(surroundings_of(*answer), "clearance");
  ASSERT_EQ(shown.size(), 2u);
  EXPECT_EQ(shown[0].type, Marker::LINE_LIST);
  EXPECT_EQ(point(shown[0], 0), to_eigen(answer->clearance.on_tool));
  EXPECT_EQ(point(shown[0], 1), to_eigen(answer->clearance.on_organ));
  EXPECT_EQ(shown[1].type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(shown[1].text, "32.0 mm");
  answer->clearance.unresolved = true;
  EXPECT_EQ(surroundings_of(*answer).markers.at(1).text, "at most 32.0 mm");
  for (const std::uint8_t state : {Clearance::NOT_ASKED, Clearance::BEYOND_MARGIN}) {
    answer->clearance.state = state;
    EXPECT_TRUE(surroundings_of(*answer).markers.empty());
  }
}

TEST(ClearanceMarkers, TheTextHasAPlaceForAnyNormal) {
  const auto answer = answer_near();
  for (const Vector3d& normal :
       {Vector3d(0.0, 0.0, 1.0), Vector3d(0.0, 0.0, -1.0), Vector3d(1.0, 0.0, 0.0)}) {
    answer->clearance.normal = to_vector(normal);
    const Vector3d place = to_eigen(surroundings_of(*answer).markers.at(1).pose.position);
    const Vector3d middle =
        0.5 * (to_eigen(answer->clearance.on_tool) + to_eigen(answer->clearance.on_organ));
    EXPECT_NEAR((place - middle).dot(normal), -0.06 * square().size(), 1e-6);  // on the tool's side
    EXPECT_NEAR((place - middle).cross(normal).norm(), 0.10 * square().size(), 1e-6);
  }
}

TEST(NearFaces, TheNearestAreDrawnAndTheNearerTheMoreOpaque) {
  const auto answer = answer_near();
  EXPECT_TRUE(find_markers(surroundings_of(*answer), "near").empty());
  answer->near = {contact_at(1, -0.01, 0, 0), contact_at(0, -0.04, 0, 0)};
  const Marker faces = find_markers(surroundings_of(*answer), "near").at(0);
  ASSERT_EQ(faces.points.size(), 12u);  // Two sides of each face.
  ASSERT_EQ(faces.colors.size(), faces.points.size());
  EXPECT_NEAR(faces.colors[6].a / faces.colors[0].a, 0.2 / 0.8, 1e-5);
  answer->near.assign(kMostNearFaces + 5, contact_at(0, -0.01, 0, 0));
  EXPECT_EQ(find_markers(surroundings_of(*answer), "near").at(0).points.size(), 6 * kMostNearFaces);
}

TEST(CrossingMarkers, StandBeforeAnEntryAndBehindAnExit) {
  const auto cones = cones_of({crossing(0.4, 1), crossing(0.7, -1)});
  ASSERT_EQ(cones.size(), 2u);
  EXPECT_TRUE(point(cones[0], 1).isApprox(kAxis.at(0.4), 1e-9));
  EXPECT_TRUE(point(cones[1], 0).isApprox(kAxis.at(0.7), 1e-9));
  EXPECT_NE(cones[0].color, cones[1].color);
  const Vector3d along = (kAxis.tip - kAxis.trocar).normalized();
  for (const Marker& cone : cones) {
    EXPECT_NEAR((point(cone, 1) - point(cone, 0)).normalized().dot(along), 1.0, 1e-9);
    EXPECT_NEAR(cone.scale.y, 2 * 2.5 * 0.02, 1e-9);  // Wider than the shaft.
  }
}

TEST(CrossingMarkers, AreNotTooMany) {
  EXPECT_TRUE(cones_of({}).empty());
  const std::vector<Crossing> many(kMostCrossings + 7, crossing(0.4, 1));
  EXPECT_EQ(cones_of(many).size(), kMostCrossings);
}

TEST(StatusLine, TellsWhatTheAnswerTells) {
  const auto touching = answer_with({contact_at(0, -0.001, 0, 0), contact_at(1, 0.0349, 0, 0)});
  const auto beyond = answer_with({}), near = answer_near(), inside = answer_with({});
  beyond->clearance.margin = 0.02;
  beyond->clearance.state = Clearance::BEYOND_MARGIN;
  inside->placement.tip = ToolPlacement::INSIDE;
  inside->placement.length_inside = 0.0321;
  const auto outside = answer_with({}), on_surface = answer_with({}), failed = answer_with({});
  outside->placement.tip = ToolPlacement::OUTSIDE;
  on_surface->placement.tip = ToolPlacement::ON_SURFACE;
  failed->status = ContactArray::NO_TRANSFORM;
  failed->message = "frame 'hook_tip' is unknown";
  const auto near_and_touching = answer_near();
  near_and_touching->contacts = {contact_at(0, 0.0012, 0, 0)};
  const std::pair<ContactArrayConstPtr, const char*> lines[] = {
      {nullptr, "hook: no answer yet"},
      {failed, "hook: no transform: frame 'hook_tip' is unknown"},
      {outside, "hook: touches nothing"},
      {beyond, "hook: touches nothing, more than 20.0 mm away"},
      {near, "hook: touches nothing, 32.0 mm away"},
      {touching, "hook: 2 contacts, 34.9 mm deep"},
      {near_and_touching, "hook: 1 contact, 1.2 mm deep"},
      {on_surface, "hook: touches nothing, tip on the surface"},
      {inside, "hook: touches nothing, tip inside, 32.1 mm of its axis inside"}};
  for (const auto& [answer, line] : lines) EXPECT_EQ(status_line("hook", answer), line);
}

TEST(StatusMarkers, StandAboveTheOrganAndAreRedWithoutAnAnswer) {
  Scene scene = hook_over_square();
  scene.organs.push_back(square("kidney"));
  scene.pairs[0].answer = answer_with({contact_at(0, 0.0012, 0, 0)});
  MarkerArray picture;
  add_status(scene, scene.organs[0], 42e-6, picture);
  add_status(scene, scene.organs[1], 0.0, picture);
  const auto failed = answer_with({});
  failed->status = ContactArray::STALE_MESH;
  scene.pairs[0].answer = failed;
  add_status(scene, scene.organs[0], 0.0, picture);
  const auto& texts = picture.markers;
  ASSERT_EQ(texts.size(), 3u);
  EXPECT_EQ(texts[0].text, "liver: 2 faces\nhook: 1 contact, 1.2 mm deep\n42 us a query");
  EXPECT_EQ(texts[0].header.frame_id, "liver_frame");
  EXPECT_EQ(texts[0].color, colours::kText);
  EXPECT_DOUBLE_EQ(texts[0].pose.position.x, 0.5);
  EXPECT_GT(texts[0].pose.position.z, 0.0);
  EXPECT_EQ(texts[1].text, "kidney: 2 faces");
  EXPECT_EQ(texts[2].color, colours::kFailure);
}
