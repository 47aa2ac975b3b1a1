#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "query_services_fixture.hpp"
#include "ros/queries/query_services.hpp"

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
