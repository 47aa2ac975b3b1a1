#include "ros/steps/contact_array.hpp"

#include <gtest/gtest.h>

#include "ros/messages/conversions.hpp"
#include "ros/messages/text.hpp"

using namespace organ_collision;

namespace {

DeformableOrgan liver() {
  return {"liver", "liver_frame", TriangleMesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}, 7),
          ros::Time(10), ros::Time(12)};
}

}  // namespace

TEST(Answers, AboutAnOrganAndATool) {
  const DeformableOrgan organ = liver();
  ContactArray answer = answer_about("liver", "hook", ContactArray::SWEPT, ros::Time(11));
  set_organ(answer, organ, organ.latest());
  EXPECT_EQ(answer.organ, "liver");
  EXPECT_EQ(answer.tool, "hook");
  EXPECT_EQ(answer.mode, ContactArray::SWEPT);
  EXPECT_EQ(answer.header.stamp, ros::Time(11));
  EXPECT_EQ(answer.step_start, ros::Time(11));
  EXPECT_EQ(answer.header.frame_id, "liver_frame");
  EXPECT_EQ(answer.topology, 7u);
  EXPECT_EQ(answer.mesh_stamp, ros::Time(10));
  EXPECT_EQ(answer.links, std::vector<std::string>{""});
}

TEST(Answers, AFailureIsEmpty) {
  const ContactArray empty = answer_about("liver", "hook", ContactArray::STATIC, ros::Time(11));
  ContactArray answer = empty, expected = empty;
  answer.contacts.resize(3);
  answer.regions.resize(3);
  answer.near.resize(2);
  answer.unresolved = answer.near_left_out = answer.near_unresolved = 5;
  answer.clearance.state = Clearance::KNOWN;
  answer.placement.tip = ToolPlacement::INSIDE;
  answer.placement.crossings.resize(1);
  set_failure(answer, ContactArray::NO_TRANSFORM, "no transform from a to b");
  expected.status = ContactArray::NO_TRANSFORM;
  expected.message = "no transform from a to b";
  EXPECT_EQ(answer, expected);
}

TEST(Answers, TextThatCameWithAMessageIsPlainAndShort) {
  const std::string huge(10'000'000, 'x');
  ContactArray answer = answer_about("o\n" + huge, "t\xFF" + huge, ContactArray::STATIC, {});
  EXPECT_LE(answer.organ.size(), kLongestName);
  EXPECT_EQ(answer.organ.rfind("o xxx", 0), 0u) << answer.organ;
  EXPECT_LE(answer.tool.size(), kLongestName);
  EXPECT_EQ(answer.tool.rfind("t?xxx", 0), 0u) << answer.tool;
  set_failure(answer, ContactArray::NO_TRANSFORM, "m\n" + huge);
  EXPECT_LE(answer.message.size(), kLongestMessage);
  EXPECT_EQ(answer.message.rfind("m xxx", 0), 0u) << answer.message;
}

TEST(Answers, StaleIsOlderThanTheLimit) {
  const OrganShape shape = liver().latest();
  EXPECT_FALSE(is_stale(shape, ros::Time(99), 0.0));
  EXPECT_FALSE(is_stale(shape, ros::Time(12), 2.0));
  EXPECT_TRUE(is_stale(shape, ros::Time(12.1), 2.0));
  EXPECT_FALSE(is_stale(shape, ros::Time(3), 2.0));  // The clock has jumped back.
  EXPECT_TRUE(is_stale({nullptr, ros::Time(3600), ros::Time(10)}, ros::Time(13), 2.0))
      << "a stamp of the future does not keep a shape fresh";
}

TEST(QueryConversions, EveryFieldOfAContact) {
  FaceContact contact;
  contact.face = 4000000000u;
  contact.link = 7;
  contact.fraction = 0.25;
  contact.point = {1.0, 2.0, 3.0};
  contact.normal = {0.6, 0.0, -0.8};
  contact.barycentric = {0.2, 0.3, 0.5};
  contact.shaft = 0.75;
  contact.depth = -0.001;
  contact.behind = true;
  contact.view_min = 0.01;
  contact.view_max = 0.02;
  const Contact message = to_message(contact);
  EXPECT_EQ(message.face, 4000000000u);
  EXPECT_EQ(message.link, 7u);
  EXPECT_EQ(message.fraction, 0.25);
  EXPECT_EQ(to_eigen(message.point), contact.point);
  EXPECT_EQ(message.normal.x, 0.6);
  EXPECT_EQ(message.normal.z, -0.8);
  EXPECT_EQ(message.barycentric[0], 0.2);
  EXPECT_EQ(message.barycentric[2], 0.5);
  EXPECT_EQ(message.shaft, 0.75);
  EXPECT_EQ(message.depth, -0.001);
  EXPECT_TRUE(message.behind);
  EXPECT_EQ(message.view_min, 0.01);
  EXPECT_EQ(message.view_max, 0.02);
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
  const Clearance message = to_message(clearance);
  EXPECT_EQ(message.state, Clearance::KNOWN);
  EXPECT_EQ(message.margin, 0.02);
  EXPECT_TRUE(message.unlimited);
  EXPECT_EQ(message.distance, 0.011);
  EXPECT_EQ(message.least, 0.003);
  EXPECT_EQ(message.least_fraction, 0.4);
  EXPECT_EQ(message.face, 4000000001u);
  EXPECT_EQ(message.vertices, (Clearance::_vertices_type{7, 5, 6}));
  EXPECT_EQ(message.barycentric, (Clearance::_barycentric_type{0.2, 0.3, 0.5}));
  EXPECT_EQ(message.link, 3u);
  EXPECT_EQ(to_eigen(message.on_organ), clearance.on_organ);
  EXPECT_EQ(to_eigen(message.on_tool), clearance.on_tool);
  EXPECT_EQ(to_eigen(message.normal), clearance.normal);
  EXPECT_TRUE(message.normal_defined);
  EXPECT_TRUE(message.unresolved);
  EXPECT_EQ(to_message(ToolClearance()), Clearance());
}

TEST(QueryConversions, EveryFieldOfAPlacement) {
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
  EXPECT_EQ(message.tip, ToolPlacement::INSIDE);
  EXPECT_EQ(message.trocar, ToolPlacement::ON_SURFACE);
  EXPECT_TRUE(message.length_known);
  EXPECT_EQ(message.length_inside, 0.032);
  ASSERT_EQ(message.crossings.size(), 2u);
  EXPECT_EQ(message.crossings[0], Crossing());
  EXPECT_EQ(message.crossings[1].face, 4000000002u);
  EXPECT_EQ(message.crossings[1].vertices, (Crossing::_vertices_type{3, 9, 4}));
  EXPECT_EQ(message.crossings[1].barycentric, (Crossing::_barycentric_type{0.1, 0.2, 0.7}));
  EXPECT_EQ(message.crossings[1].shaft, 0.75);
  EXPECT_EQ(to_eigen(message.crossings[1].point), crossing.point);
  EXPECT_EQ(message.crossings[1].direction, -1);
}

TEST(QueryConversions, RegionKeepsItsCorners) {
  const geometry_msgs::Polygon polygon = to_message(Region{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.5}});
  ASSERT_EQ(polygon.points.size(), 2u);
  EXPECT_EQ(polygon.points[1].y, 5.0f);
  EXPECT_EQ(polygon.points[1].z, 6.5f);
  EXPECT_TRUE(to_message(Region{}).points.empty());
}

TEST(ContactQuery, ARequestWithoutAnswerBecomesAStatus) {
  const TriangleMesh face({-1, -1, 0, 1, -1, 0, 0, 1, 0}, {0, 1, 2});
  CollisionRequest request;
  request.organ = &face;
  request.path = {{0.0, {{0.0, 0.0, 1.0}, {0.1, 0.0, -0.5}}}};
  request.radius = 0.01;
  for (const PickerKind kind : {PickerKind::kFeedback, PickerKind::kSelect, PickerKind::kCpu}) {
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
