#include "ros/queries/query_services.hpp"

#include <gtest/gtest.h>

#include "query_services_fixture.hpp"

using namespace organ_collision;

TEST_F(QueryServicesTest, SweptAndStatic) {
  ContactArray answer = services.query(request);
  EXPECT_EQ(answer.status, ContactArray::OK) << answer.message;
  ASSERT_EQ(answer.contacts.size(), 1u);
  EXPECT_EQ(answer.contacts[0].face, 1u);
  EXPECT_EQ(answer.header.frame_id, "liver_frame");
  EXPECT_EQ(answer.mesh_stamp, ros::Time(1.0));
  request.mode = ContactArray::STATIC;
  request.motion.tip = tf2::toMsg(kAbove);
  request.motion.previous_tip = tf2::toMsg(kBelow);
  answer = services.query(request);
  EXPECT_EQ(answer.status, ContactArray::OK);
  EXPECT_TRUE(answer.contacts.empty());
}

TEST_F(QueryServicesTest, MotionInAnotherFrame) {
  const Eigen::Isometry3d T_liver_table =
      Eigen::Translation3d(0.5, -0.3, 0.2) *
      Eigen::AngleAxisd(0.9, Eigen::Vector3d(0.2, 1.0, -0.6).normalized());
  set_transform(transforms, "liver_frame", "table", 4.0, T_liver_table);
  const ContactArray here = services.query(request);
  for (geometry_msgs::Point* point : {&request.motion.previous_trocar, &request.motion.previous_tip,
                                      &request.motion.trocar, &request.motion.tip}) {
    *point = tf2::toMsg(Eigen::Vector3d(T_liver_table.inverse() * to_eigen(*point)));
  }
  request.header.frame_id = "/table";
  const ContactArray there = services.query(request);
  ASSERT_EQ(there.status, ContactArray::OK) << there.message;
  EXPECT_EQ(there.header.stamp, ros::Time(4.0));
  ASSERT_EQ(there.contacts.size(), 1u);
  EXPECT_EQ(there.contacts[0].face, here.contacts[0].face);
  EXPECT_NEAR(there.contacts[0].depth, here.contacts[0].depth, 1e-9);
  EXPECT_NEAR(there.contacts[0].point.x, here.contacts[0].point.x, 1e-9);
  request.header.stamp = ros::Time(5.0);
  expect_refused(ContactArray::NO_TRANSFORM, {"table", "liver_frame"});
}

TEST_F(QueryServicesTest, OrganMovesOnRequest) {
  send_vertices(1.1, 2.0f);
  request.motion.previous_tip = request.motion.tip = tf2::toMsg(kAbove);
  EXPECT_TRUE(services.query(request).contacts.empty());
  request.organ_motion = true;
  EXPECT_EQ(services.query(request).contacts.size(), 2u);
  request.mode = ContactArray::STATIC;
  EXPECT_TRUE(services.query(request).contacts.empty());
}

TEST_F(QueryServicesTest, ToolFromItsLastPublishedPose) {
  request.tool = "hook";
  request.motion = {};
  send_tip(1.0, kAbove);
  evaluate();
  send_tip(1.1, kBelow);
  send_tip(1.2, {0.1, 0.2, -0.4});
  const ContactArray answer = services.query(request);
  ASSERT_EQ(answer.status, ContactArray::OK) << answer.message;
  EXPECT_EQ(answer.tool, "hook");
  EXPECT_EQ(answer.step_start, ros::Time(1.0));
  EXPECT_EQ(answer.header.stamp, ros::Time(1.2));
  EXPECT_EQ(answer.contacts.size(), 1u);
  request.header.stamp = ros::Time(1.05);
  EXPECT_EQ(services.query(request).header.stamp, ros::Time(1.05));
  request.mode = ContactArray::STATIC;
  EXPECT_EQ(services.query(request).step_start, ros::Time(1.05));
}

TEST_F(QueryServicesTest, AStampThatWasAheadDoesNotHoldTheTool) {
  request.tool = "hook";
  request.motion = {};
  send_tip(50.8, kAbove);
  send_vertices(50.8, 0.0);
  evaluate();
  send_tip(50.01, kBelow);
  const ContactArray answer = services.query(request);
  EXPECT_EQ(answer.status, ContactArray::OK) << answer.message;
  EXPECT_EQ(answer.header.stamp, ros::Time(50.01));
  EXPECT_EQ(answer.step_start, ros::Time(50.01));
  EXPECT_EQ(answer.contacts.size(), 1u);
}

TEST_F(QueryServicesTest, AWayThatIsNotWhollyKnownIsSaid) {
  request.tool = "hook";
  request.motion = {};
  send_tip(1.0, kAbove);
  evaluate();
  send_tip(2.0, kBelow);
  send_tip(15.0, kAbove);
  const ContactArray answer = services.query(request);
  EXPECT_EQ(answer.status, ContactArray::OK) << answer.message;
  EXPECT_TRUE(answer.path_incomplete);
  EXPECT_NE(answer.message.find("longer ago than transforms are kept"), std::string::npos)
      << answer.message;
}

TEST_F(QueryServicesTest, ToolThatWasNeverEvaluatedRests) {
  request.tool = "hook";
  request.motion = {};
  send_tip(1.0, kBelow);
  const ContactArray answer = services.query(request);
  ASSERT_EQ(answer.status, ContactArray::OK) << answer.message;
  EXPECT_EQ(answer.contacts.size(), 1u);
  EXPECT_EQ(answer.contacts[0].fraction, 0.0);
  EXPECT_EQ(answer.step_start, answer.header.stamp);
}

TEST_F(QueryServicesTest, HistoryIsLeftAlone) {
  request.tool = "hook";
  request.motion = {};
  send_tip(1.0, kAbove);
  evaluate();
  send_tip(1.1, kBelow);
  EXPECT_EQ(services.query(request).contacts.size(), 1u);
  ASSERT_TRUE(steps.history().last("liver", 0));
  EXPECT_EQ(steps.history().last("liver", 0)->stamp, ros::Time(1.0));
}

TEST_F(QueryServicesTest, PaperModesGiveFacesAndDepthRanges) {
  for (const std::uint8_t mode :
       {ContactArray::PAPER_STATIC, ContactArray::PAPER_SWEPT, ContactArray::PAPER_NAIVE}) {
    request.mode = mode;
    const ContactArray answer = services.query(request);
    ASSERT_EQ(answer.status, ContactArray::OK) << answer.message;
    ASSERT_EQ(answer.contacts.size(), 1u) << int(mode);
    EXPECT_EQ(answer.contacts[0].face, 1u);
    EXPECT_LE(answer.contacts[0].view_min, answer.contacts[0].view_max);
    EXPECT_GT(answer.contacts[0].view_max, 0.0);
    EXPECT_EQ(answer.contacts[0].normal.z, 0.0);
  }
}

TEST_F(QueryServicesTest, RegionsOnRequest) {
  EXPECT_TRUE(services.query(request).regions.empty());
  request.regions = true;
  EXPECT_EQ(services.query(request).regions.size(), 1u);
}

TEST_F(QueryServicesTest, ASurfaceThatIsNeverInspectedHasCrossingsButNoSides) {
  request.placement = true;
  const ContactArray answer = services.query(request);
  EXPECT_EQ(answer.status, ContactArray::OK) << answer.message;
  EXPECT_EQ(answer.placement.tip, ToolPlacement::UNKNOWN);
  EXPECT_EQ(answer.placement.crossings.size(), 1u);
}
