#include <gtest/gtest.h>

#include "query_services_fixture.hpp"
#include "ros/queries/query_services.hpp"

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
