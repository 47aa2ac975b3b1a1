#include "ros/queries/query_services.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "query_fixtures.hpp"

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

using namespace organ_collision;

TEST_F(QueryServicesTest, BatchAnswersEachMotionInOrder) {
  QueryCollisionBatch::Request batch;
  batch.header = request.header;
  batch.organ = "liver";
  batch.mode = ContactArray::SWEPT;
  EXPECT_TRUE(services.query_batch(batch).results.empty());
  ToolMotion aside = through();
  aside.tip = aside.previous_tip;
  ToolMotion bad = through();
  bad.radius = 0.0;
  batch.motions = {through(), aside, bad, through()};
  const QueryCollisionBatch::Response response = services.query_batch(batch);
  EXPECT_EQ(response.status, ContactArray::OK);
  const std::vector<ContactArray>& results = response.results;
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[0].contacts.size(), 1u);
  EXPECT_TRUE(results[1].contacts.empty());
  EXPECT_EQ(results[1].status, ContactArray::OK);
  EXPECT_EQ(results[2].status, ContactArray::INVALID_REQUEST);
  EXPECT_EQ(results[3].contacts.size(), 1u);
}

TEST_F(QueryServicesTest, BatchThatFailsAsAWholeSaysWhy) {
  QueryCollisionBatch::Request good;
  good.header = request.header;
  good.organ = "liver";
  good.motions = {through(), through()};
  const auto expect_fails = [&](std::uint8_t status, const char* word, auto set) {
    QueryCollisionBatch::Request batch = good;
    set(batch);
    const QueryCollisionBatch::Response response = services.query_batch(batch);
    EXPECT_EQ(response.status, status) << response.message;
    EXPECT_NE(response.message.find(word), std::string::npos) << response.message;
    EXPECT_TRUE(response.results.empty());
  };
  using Batch = QueryCollisionBatch::Request;
  const std::uint8_t invalid = ContactArray::INVALID_REQUEST;
  expect_fails(invalid, "organ is empty", [](Batch& b) { b.organ = ""; });
  expect_fails(ContactArray::UNKNOWN_ORGAN, "'spleen'", [](Batch& b) { b.organ = "spleen"; });
  expect_fails(invalid, "mode is 5", [](Batch& b) { b.mode = 5; });
  expect_fails(invalid, "frame_id is empty", [](Batch& b) { b.header.frame_id = ""; });
  expect_fails(ContactArray::NO_TRANSFORM, "nowhere",
               [](Batch& b) { b.header.frame_id = "nowhere"; });
  expect_fails(invalid, "frame_id", [](Batch& b) { b.header.frame_id = std::string(257, 'x'); });
  parameters.mesh_timeout_sec = 2.0;
  expect_fails(ContactArray::STALE_MESH, "'liver'", [](Batch&) {});
}

TEST_F(QueryServicesTest, BatchInAnotherFrameIsAsItsQueries) {
  set_transform(transforms, "liver_frame", "table", 4.0,
                Eigen::Isometry3d(Eigen::Translation3d(0.5, -0.3, 0.2)));
  QueryCollisionBatch::Request batch;
  batch.header.frame_id = request.header.frame_id = "table";
  batch.organ = "liver";
  batch.mode = ContactArray::SWEPT;
  batch.motions = {through()};
  const QueryCollisionBatch::Response response = services.query_batch(batch);
  ASSERT_EQ(response.results.size(), 1u);
  const ContactArray single = services.query(request), &of_batch = response.results[0];
  EXPECT_EQ(of_batch.header.frame_id, single.header.frame_id);
  EXPECT_EQ(of_batch.header.stamp, ros::Time(4.0));
  EXPECT_EQ(of_batch.step_start, single.step_start);
  EXPECT_EQ(of_batch.mesh_stamp, single.mesh_stamp);
  EXPECT_EQ(of_batch.links, single.links);
  ASSERT_EQ(of_batch.contacts.size(), 1u);
  EXPECT_EQ(of_batch.contacts[0].point.x, single.contacts[0].point.x);
}

TEST_F(QueryServicesTest, BatchOfTooManyMotionsIsRefused) {
  QueryCollisionBatch::Request batch;
  batch.header = request.header;
  batch.organ = "liver";
  parameters.max_batch = 3;
  batch.motions.assign(3, through());
  EXPECT_EQ(services.query_batch(batch).results.size(), 3u);
  batch.motions.assign(4, through());
  const QueryCollisionBatch::Response response = services.query_batch(batch);
  EXPECT_EQ(response.status, ContactArray::INVALID_REQUEST);
  EXPECT_EQ(response.message,
            "the batch has 4 motions; must be at most 3 (max_batch): ask in several batches");
  EXPECT_TRUE(response.results.empty());
}

TEST_F(QueryServicesTest, BatchWhoseResultsGrowTooLargeIsRefused) {
  QueryCollisionBatch::Request batch;
  batch.header = request.header;
  batch.organ = "liver";
  batch.mode = ContactArray::SWEPT;
  batch.motions.assign(5, through());
  const std::uint32_t one = ros::serialization::serializationLength(services.query(request));
  const std::uint32_t all =
      5 * one + ros::serialization::serializationLength(QueryCollisionBatch::Response());
  parameters.max_batch_bytes = static_cast<int>(all);
  EXPECT_EQ(ros::serialization::serializationLength(services.query_batch(batch)), all);
  parameters.max_batch_bytes -= 1;
  EXPECT_EQ(services.query_batch(batch).message,
            "the answers to the first 5 of 5 motions have " + std::to_string(all) +
                " bytes; a batch's must have at most " + std::to_string(all - 1) +
                " (max_batch_bytes): ask for fewer motions at once");
  parameters.max_batch_bytes = static_cast<int>(all - 4 * one);
  const QueryCollisionBatch::Response response = services.query_batch(batch);
  EXPECT_EQ(response.status, ContactArray::INVALID_REQUEST);
  EXPECT_NE(response.message.find("first 2 of 5"), std::string::npos) << response.message;
  EXPECT_TRUE(response.results.empty());
}

using namespace organ_collision;

TEST_F(QueryServicesTest, RefusesWithStatusValueAndWhatIsLegal) {
  const QueryCollision::Request good = request;
  request.organ = "spleen";
  expect_refused(ContactArray::UNKNOWN_ORGAN, {"'spleen'", "'liver'"});
  request = good;
  request.organ = "";
  expect_refused(ContactArray::INVALID_REQUEST, {"organ", "empty"});
  request = good;
  request.tool = "saw";
  request.motion = {};
  expect_refused(ContactArray::UNKNOWN_TOOL, {"'saw'", "'hook'"});
  request = good;
  request.mode = 5;
  expect_refused(ContactArray::INVALID_REQUEST, {"mode", "5", "0", "4"});
  request = good;
  request.header.frame_id = "";
  expect_refused(ContactArray::INVALID_REQUEST, {"frame_id", "empty"});
  request = good;
  request.header.frame_id = "nowhere";
  expect_refused(ContactArray::NO_TRANSFORM, {"nowhere", "unknown to TF"});
  request = good;
  request.motion.radius = -0.25;
  expect_refused(ContactArray::INVALID_REQUEST, {"radius", "-0.25", "positive"});
  request.motion.radius = std::nan("");
  expect_refused(ContactArray::INVALID_REQUEST, {"radius", "nan", "finite"});
  request = good;
  request.motion.previous_tip.y = std::numeric_limits<double>::infinity();
  expect_refused(ContactArray::INVALID_REQUEST, {"previous_tip", "inf", "finite"});
  request.mode = ContactArray::STATIC;
  EXPECT_EQ(services.query(request).status, ContactArray::OK);  // Unused when static.
  request = good;
  request.mode = ContactArray::PAPER_STATIC;
  request.motion.tip = request.motion.trocar;
  expect_refused(ContactArray::INVALID_REQUEST, {});
  request = good;
  request.tool = "hook";
  expect_refused(ContactArray::INVALID_REQUEST, {"motion is set", "'hook' moves as in TF"});
  request.motion = {};
  expect_refused(ContactArray::NO_TRANSFORM, {"hook_tip"});
}

TEST_F(QueryServicesTest, IllegalNamesAreRefusedInAShortAnswer) {
  const QueryCollision::Request good = request;
  const auto refuses = [&](std::string QueryCollision::Request::*field, const char* word) {
    for (const std::string& name : {std::string(10'000'000, 'x'), std::string("a\nb")}) {
      request = good;
      request.*field = name;
      expect_refused(ContactArray::INVALID_REQUEST, {word, "256"});
      EXPECT_LT(ros::serialization::serializationLength(services.query(request)), 4000u);
    }
  };
  refuses(&QueryCollision::Request::organ, "organ");
  refuses(&QueryCollision::Request::tool, "tool");
  request = good;
  request.header.frame_id = std::string(10'000'000, 'x');
  expect_refused(ContactArray::INVALID_REQUEST, {"header.frame_id", "256"});
  EXPECT_LT(ros::serialization::serializationLength(services.query(request)), 4000u);
}

TEST_F(QueryServicesTest, SweepsBackwardsInTimeAreRefused) {
  request.tool = "hook";
  request.motion = {};
  send_tip(1.0, kAbove);
  send_tip(1.2, kBelow);
  send_vertices(1.125, 0.0);
  evaluate();
  request.header.stamp = ros::Time(1.0625);
  for (const std::uint8_t mode :
       {ContactArray::SWEPT, ContactArray::PAPER_SWEPT, ContactArray::PAPER_NAIVE}) {
    request.mode = mode;
    expect_refused(ContactArray::INVALID_REQUEST, {"'hook'", "1.062500000", "1.125000000"});
  }
  request.mode = ContactArray::STATIC;
  EXPECT_EQ(services.query(request).status, ContactArray::OK);
  request.mode = ContactArray::SWEPT;
  request.header.stamp = ros::Time(1.125);
  const ContactArray at_rest = services.query(request);
  EXPECT_EQ(at_rest.status, ContactArray::OK) << at_rest.message;
  EXPECT_EQ(at_rest.step_start, at_rest.header.stamp);
}

TEST_F(QueryServicesTest, RemovedOrganAndStaleMesh) {
  parameters.mesh_timeout_sec = 2.0;
  expect_refused(ContactArray::STALE_MESH, {"'liver'", "49", "2"});
  OrganMesh nothing;
  nothing.organ = "liver";
  organs.apply(boost::make_shared<OrganMesh>(nothing), ros::Time(51));
  expect_refused(ContactArray::NO_MESH, {"'liver'"});
}

TEST_F(QueryServicesTest, IllegalMarginsAreRefusedWithTheirValue) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const auto& [margin, word] :
       {std::pair(-0.25, "-0.25"), std::pair(nan, "nan"), std::pair(infinity, "inf")}) {
    request.margin = margin;
    expect_refused(ContactArray::INVALID_REQUEST, {"margin", word, "positive and finite"});
    QueryCollisionBatch::Request batch;
    batch.header = request.header;
    batch.organ = request.organ;
    batch.motions = {request.motion};
    batch.margin = margin;
    const QueryCollisionBatch::Response response = services.query_batch(batch);
    EXPECT_EQ(response.status, ContactArray::INVALID_REQUEST);
    EXPECT_NE(response.message.find(word), std::string::npos) << response.message;
    EXPECT_TRUE(response.results.empty());
  }
}

TEST_F(QueryServicesTest, NearFacesNeedAMargin) {
  request.max_near = 7;
  expect_refused(ContactArray::INVALID_REQUEST, {"max_near", "7", "margin"});
  request.clearance = true;
  expect_refused(ContactArray::INVALID_REQUEST, {"max_near", "7", "margin"});
}

TEST_F(QueryServicesTest, ThePapersModesHaveOnlyContacts) {
  const QueryCollision::Request good = request;
  const auto refuses = [&](auto set) {
    for (const std::uint8_t mode :
         {ContactArray::PAPER_STATIC, ContactArray::PAPER_SWEPT, ContactArray::PAPER_NAIVE}) {
      request = good;
      request.mode = mode;
      EXPECT_EQ(services.query(request).status, ContactArray::OK);
      set(request);
      expect_refused(ContactArray::INVALID_REQUEST, {"mode is " + std::to_string(mode), "1"});
    }
  };
  refuses([](auto& r) { r.margin = 0.01; });
  refuses([](auto& r) { r.clearance = true; });
  refuses([](auto& r) { r.placement = true; });
}
