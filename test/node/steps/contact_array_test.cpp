#include "node/steps/contact_array.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "common/messages/text.hpp"
#include "node/steps/question.hpp"

using namespace organ_collision;

namespace {

DeformableOrgan liver() {
  return {"liver", "liver_frame", TriangleMesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}, 7),
          ros::Time(10), ros::Time(12)};
}

/// All fields of a message in one line.
template <typename Message>
std::string fields_of(const Message& message) {
  std::stringstream words;
  words << message;
  std::string text;
  for (std::string word; words >> word;) text += (text.empty() ? "" : " ") + word;
  return text;
}

Question about_hook() {
  Question question;
  question.organ = "liver";
  question.tool_name = "hook";
  question.start = question.end = ros::Time(11);
  return question;
}

}  // namespace

TEST(Answers, AboutAnOrganAndATool) {
  const DeformableOrgan organ = liver();
  Question question = about_hook();
  question.asked.mode = QueryMode::kSwept;
  question.set_organ(organ, organ.latest());
  const ContactArray answer = question.unanswered();
  ContactArray expected;
  expected.organ = "liver";
  expected.tool = "hook";
  expected.mode = ContactArray::SWEPT;
  expected.header.stamp = expected.step_start = ros::Time(11);
  expected.header.frame_id = "liver_frame";
  expected.topology = 7;
  expected.mesh_stamp = ros::Time(10);
  EXPECT_EQ(answer, expected);
}

TEST(Answers, AFailureIsEmpty) {
  const ContactArray empty = about_hook().unanswered();
  ContactArray answer = empty, expected = empty;
  answer.contacts.resize(3);
  answer.released = {1};
  answer.view_min = answer.view_max = {0.5};
  answer.regions.resize(3);
  answer.near.resize(2);
  answer.unresolved = answer.near_unresolved = 5;
  answer.near_more = true;
  answer.clearance.state = Clearance::KNOWN;
  answer.placement.tip = ToolPlacement::INSIDE;
  answer.placement.crossings.resize(1);
  set_failure(answer, ContactArray::NO_TRANSFORM, "no transform from a to b");
  expected.status = ContactArray::NO_TRANSFORM;
  expected.message = "no transform from a to b";
  EXPECT_EQ(answer, expected);
}

/// A contact since a time [s].
Contact since(std::uint32_t face, std::int32_t link, double time, bool touching = true) {
  Contact contact;
  contact.face = face;
  contact.link = link;
  contact.since = ros::Time(time);
  contact.touching = touching;
  return contact;
}

TEST(Answers, RememberSinceWhenEachLinkTouchesEachFace) {
  ContactArray last, now;
  last.contacts = {since(2, -1, 5.0), since(2, 0, 6.0), since(4, 0, 7.0, false), since(8, 1, 8.0)};
  now.contacts = {since(1, -1, 0.0), since(2, -1, 0.0), since(2, 0, 0.0), since(4, 0, 0.0),
                  since(8, 0, 0.0)};
  now.contacts[2].fraction = 0.5;  // It had left the face, and came back.
  now.contacts[4].touching = false;
  now.step_start = ros::Time(10);
  now.header.stamp = ros::Time(11);
  set_memory(now, &last);
  const double expected[] = {10.0, 5.0, 10.5, 10.0, 10.0};
  for (std::size_t i = 0; i < now.contacts.size(); ++i) {
    EXPECT_EQ(now.contacts[i].since, ros::Time(expected[i])) << i;
  }
  EXPECT_EQ(now.released, (std::vector<std::uint32_t>{8}));
  now.released.clear();
  set_memory(now, nullptr);
  for (const Contact& contact : now.contacts) {
    EXPECT_EQ(contact.since, ros::Time(10.0 + contact.fraction));
  }
  EXPECT_TRUE(now.released.empty());
  ContactArray failed;
  set_failure(failed, ContactArray::NO_TRANSFORM, "why");
  set_memory(failed, &last);
  EXPECT_TRUE(failed.released.empty());
}

TEST(QueryConversions, EveryFieldOfAContact) {
  FaceContact contact;
  contact.face = 4000000000u;
  contact.vertices = {9, 5, 6};
  contact.link = 7;
  contact.fraction = 0.25;
  contact.point = {1.0, 2.0, 3.0};
  contact.normal = {0.6, 0.0, -0.8};
  contact.barycentric = {0.2, 0.3, 0.5};
  contact.shaft = 0.75;
  contact.depth = -0.001;
  contact.behind = true;
  contact.on_organ = {1.5, 2.5, 3.5};
  contact.velocity = {0.1, 0.2, 0.4};
  contact.touching = true;
  EXPECT_EQ(fields_of(to_message(contact)),
            "face: 4000000000 vertices[] vertices[0]: 9 vertices[1]: 5 vertices[2]: 6 link: 7 "
            "touching: 1 since: 0.000000000 fraction: 0.25 point: x: 1 y: 2 z: 3 normal: x: 0.6 y: "
            "0 z: -0.8 barycentric[] "
            "barycentric[0]: 0.2 barycentric[1]: 0.3 barycentric[2]: 0.5 shaft: 0.75 "
            "depth: -0.001 behind: 1 on_organ: x: 1.5 y: 2.5 z: 3.5 "
            "velocity: x: 0.1 y: 0.2 z: 0.4 on_tool: x: 1.4994 y: 2.5 z: 3.5008");
}

TEST(QueryConversions, EveryFieldOfAClearance) {
  ToolClearance clearance;
  clearance.state = ClearanceState::kKnown;
  clearance.margin = 0.02;
  clearance.unlimited = true;
  clearance.distance = 0.011;
  clearance.least = 0.003;
  clearance.least_fraction = 0.4;
  clearance.face = 4000000001u;
  clearance.vertices = {7, 5, 6};
  clearance.barycentric = {0.2, 0.3, 0.5};
  clearance.link = 3;
  clearance.on_organ = {1.0, 2.0, 3.0};
  clearance.on_tool = {4.0, 5.0, 6.5};
  clearance.normal = {0.6, 0.0, -0.8};
  clearance.normal_defined = true;
  clearance.is_resolved = false;
  clearance.closing_speed = 0.25;
  EXPECT_EQ(fields_of(to_message(clearance)),
            "state: 2 margin: 0.02 unlimited: 1 distance: 0.011 least: 0.003 least_fraction: 0.4 "
            "face: 4000000001 vertices[] vertices[0]: 7 vertices[1]: 5 vertices[2]: 6 "
            "barycentric[] barycentric[0]: 0.2 barycentric[1]: 0.3 barycentric[2]: 0.5 link: 3 "
            "on_organ: x: 1 y: 2 z: 3 on_tool: x: 4 y: 5 z: 6.5 normal: x: 0.6 y: 0 z: -0.8 "
            "normal_defined: 1 unresolved: 1 closing_speed: 0.25");
  EXPECT_EQ(to_message(ToolClearance()), Clearance());
}

TEST(QueryConversions, EveryFieldOfAPlacementAndTheCornersOfARegion) {
  AxisCrossing crossing;
  crossing.face = 4000000002u;
  crossing.vertices = {3, 9, 4};
  crossing.barycentric = {0.1, 0.2, 0.7};
  crossing.shaft = 0.75;
  crossing.point = {1.0, -2.0, 3.0};
  crossing.direction = -1;
  AxisPlacement placement;
  placement.tip = Side::kInside;
  placement.trocar = Side::kOnSurface;
  placement.crossings = {AxisCrossing(), crossing};
  placement.length_known = true;
  placement.length_inside = 0.032;
  const ToolPlacement message = to_message(placement);
  ASSERT_EQ(message.crossings.size(), 2u);
  EXPECT_EQ(message.crossings[0], Crossing());
  EXPECT_EQ(fields_of(message.crossings[1]),
            "face: 4000000002 vertices[] vertices[0]: 3 vertices[1]: 9 vertices[2]: 4 "
            "barycentric[] barycentric[0]: 0.1 barycentric[1]: 0.2 barycentric[2]: 0.7 "
            "shaft: 0.75 point: x: 1 y: -2 z: 3 direction: -1");
  EXPECT_EQ(message.tip, ToolPlacement::INSIDE);
  EXPECT_EQ(message.trocar, ToolPlacement::ON_SURFACE);
  EXPECT_TRUE(message.length_known);
  EXPECT_EQ(message.length_inside, 0.032);
  EXPECT_EQ(fields_of(to_message(Region{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.5}})),
            "points[] points[0]: x: 1 y: 2 z: 3 points[1]: x: 4 y: 5 z: 6.5");
}

TEST(ContactQuery, ARequestWithoutAnswerBecomesAStatus) {
  const TriangleMesh face({-1, -1, 0, 1, -1, 0, 0, 1, 0}, {0, 1, 2});
  CollisionRequest request;
  request.organ = &face;
  request.path = {{0.0, {{0.0, 0.0, 1.0}, {0.1, 0.0, -0.5}}}};
  request.radius = 0.01;
  for (const PickerKind kind : picker_kinds()) {
    ContactQuery query{kind};
    ContactArray answer;
    EXPECT_GT(query.evaluate(request, answer), 0.0);
    EXPECT_EQ(answer.contacts.size(), 1u);
    CollisionRequest bad = request;
    bad.radius = -0.25;
    EXPECT_EQ(query.evaluate(bad, answer), 0.0);
    EXPECT_EQ(answer.status, ContactArray::INVALID_REQUEST);
    EXPECT_NE(answer.message.find("-0.25"), std::string::npos) << answer.message;
    EXPECT_TRUE(answer.contacts.empty());
  }
}
