#include "ros/organs/organ_topics.hpp"

#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>

using namespace organ_collision;

namespace {

class OrganTopicsTest : public testing::Test {
 protected:
  OrganTopicsTest() {
    ros::Time::init();
    ros::Time::setNow(ros::Time(50.0));
  }

  static boost::shared_ptr<OrganMesh> mesh(std::size_t faces = 1) {
    const auto message = boost::make_shared<OrganMesh>();
    message->header.frame_id = "liver_frame";
    message->organ = "liver";
    message->topology = 1;
    message->vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (std::size_t i = 0; i < faces; ++i) {
      message->triangles.insert(message->triangles.end(), {0, 1, 2});
    }
    return message;
  }

  static boost::shared_ptr<OrganVertices> vertices(std::uint32_t topology) {
    const auto message = boost::make_shared<OrganVertices>();
    message->header.frame_id = "liver_frame";
    message->organ = "liver";
    message->topology = topology;
    message->vertices = {0, 0, 1, 1, 0, 1, 0, 1, 1};
    return message;
  }

  OrganRegistry organs_{MeshLimits{}};
  FailureLog rejected_;
  ros::CallbackQueue callbacks_;
  OrganTopics topics_{organs_, rejected_, callbacks_};
};

}  // namespace

TEST_F(OrganTopicsTest, MessagesAreAppliedInTheirOrder) {
  topics_.take_mesh(mesh());
  topics_.take_vertices(vertices(1));
  EXPECT_TRUE(organs_.organs().empty()) << "applied before next()";
  const auto first = topics_.next();
  ASSERT_TRUE(first && first->change);
  EXPECT_EQ(*first->change, OrganChange::kShape);
  EXPECT_EQ(first->status, ContactArray::OK);
  EXPECT_EQ(organs_.at("liver").latest().mesh->vertex(0).z(), 0.0);
  ASSERT_TRUE(topics_.next());
  EXPECT_EQ(organs_.at("liver").latest().mesh->vertex(0).z(), 1.0);
  EXPECT_FALSE(topics_.next());
}

TEST_F(OrganTopicsTest, ARefusedMessageIsCountedAndSaysWhy) {
  topics_.take_mesh(mesh());
  topics_.next();
  topics_.take_vertices(vertices(7));
  const auto update = topics_.next();
  ASSERT_TRUE(update);
  EXPECT_FALSE(update->change);
  EXPECT_EQ(update->message.organ(), "liver");
  EXPECT_EQ(update->message.header().frame_id, "liver_frame");
  EXPECT_EQ(update->status, ContactArray::INVALID_REQUEST);
  EXPECT_NE(update->why_not.find("topology is 7"), std::string::npos) << update->why_not;
  EXPECT_EQ(rejected_.by_reason().at("other topology").count, 1U);
  EXPECT_EQ(organs_.at("liver").latest().mesh->vertex(0).z(), 0.0);
}

TEST_F(OrganTopicsTest, VerticesBeforeTheFirstMeshAreAnsweredButNotCountedAtTheStart) {
  topics_.take_vertices(vertices(1));
  const auto update = topics_.next();
  ASSERT_TRUE(update);
  EXPECT_EQ(update->status, ContactArray::UNKNOWN_ORGAN);
  EXPECT_TRUE(rejected_.by_reason().empty());
}

TEST_F(OrganTopicsTest, ARemovedOrganHasNoMesh) {
  topics_.take_mesh(mesh());
  topics_.next();
  const auto removal = mesh();
  removal->vertices.clear();
  removal->triangles.clear();
  topics_.take_mesh(removal);
  const auto update = topics_.next();
  ASSERT_TRUE(update && update->change);
  EXPECT_EQ(*update->change, OrganChange::kRemoved);
  EXPECT_EQ(update->status, ContactArray::NO_MESH);
  EXPECT_TRUE(rejected_.by_reason().empty());
}

TEST_F(OrganTopicsTest, RemoveDoesWhatAnEmptyMeshDoes) {
  EXPECT_THROW(topics_.remove("liver"), Rejection);
  topics_.take_mesh(mesh());
  topics_.remove("liver");  // It may still wait.
  ASSERT_TRUE(topics_.next());
  const auto update = topics_.next();
  ASSERT_TRUE(update && update->change);
  EXPECT_EQ(*update->change, OrganChange::kRemoved);
  EXPECT_EQ(update->status, ContactArray::NO_MESH);
  EXPECT_TRUE(organs_.organs().empty());
  EXPECT_THROW(topics_.remove("liver"), Rejection) << "it is removed already";
  EXPECT_THROW(topics_.remove("\n"), Rejection);
  EXPECT_FALSE(topics_.next());
}

TEST_F(OrganTopicsTest, TellsWhatBecameOfEachMessage) {
  topics_.take_vertices(vertices(1));
  topics_.next();  // It is refused: there is no mesh.
  topics_.take_mesh(mesh(OrganMessageQueue::kLarge + 1));
  topics_.take_vertices(vertices(1));
  EXPECT_EQ(topics_.counts().received, 3U);
  EXPECT_EQ(topics_.counts().refused, 1U);
  EXPECT_EQ(topics_.counts().waiting, 2U);
  EXPECT_EQ(topics_.counts().applied, 0U);
  while (topics_.counts().waiting > 0) {
    callbacks_.callOne(ros::WallDuration(0.1));
    topics_.next();
  }
  topics_.remove("liver");
  topics_.next();
  EXPECT_EQ(topics_.counts().received, 4U);
  EXPECT_EQ(topics_.counts().applied, 2U);
  EXPECT_EQ(topics_.counts().removals, 1U);
  EXPECT_EQ(topics_.counts().dropped, 0U);
}

TEST_F(OrganTopicsTest, ALargeMeshWakesTheThreadThatWaitsForIt) {
  topics_.take_mesh(mesh(OrganMessageQueue::kLarge + 1));
  std::optional<OrganUpdate> update = topics_.next();
  while (!update) {
    callbacks_.callOne(ros::WallDuration(10.0));
    update = topics_.next();
  }
  ASSERT_TRUE(update->change);
  EXPECT_EQ(organs_.at("liver").latest().mesh->face_count(), OrganMessageQueue::kLarge + 1);
}
