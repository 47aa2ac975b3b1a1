#include "ros/organs/organ_intake.hpp"

#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>
#include <ros/callback_queue.h>

#include <atomic>
#include <boost/make_shared.hpp>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

using namespace organ_collision;

TEST(SequenceGapsTest, CountsWhatIsMissingBetweenTwoMessages) {
  SequenceGaps gaps;
  EXPECT_EQ(gaps.add("/simulator", 7), 0U) << "what came before the first one was not meant for us";
  EXPECT_EQ(gaps.add("/simulator", 8), 0U);
  EXPECT_EQ(gaps.add("/simulator", 12), 3U);
}

TEST(SequenceGapsTest, EachPublisherHasItsOwnNumbers) {
  SequenceGaps gaps;
  gaps.add("/left", 1);
  EXPECT_EQ(gaps.add("/right", 40), 0U);
  EXPECT_EQ(gaps.add("/left", 2), 0U);
  EXPECT_EQ(gaps.add("/right", 42), 1U);
}

TEST(SequenceGapsTest, AStartAgainAndAMessageWithoutANumberAreNoGap) {
  SequenceGaps gaps;
  gaps.add("/simulator", 1000);
  EXPECT_EQ(gaps.add("/simulator", 0), 0U);
  EXPECT_EQ(gaps.add("/simulator", 0), 0U) << "within a process, messages have no number";
  EXPECT_EQ(gaps.add("/simulator", 1), 0U);
}

TEST(SequenceGapsTest, ManyPublishersDoNotFillTheMemory) {
  SequenceGaps gaps;
  for (int i = 0; i <= 1000; ++i) gaps.add("/rostopic_" + std::to_string(i), 5);
  EXPECT_EQ(gaps.add("/rostopic_0", 9), 0U) << "forgotten";
  EXPECT_EQ(gaps.add("/rostopic_1000", 9), 3U) << "the newest one is known";
}

using namespace organ_collision;

namespace {

constexpr std::size_t kFaces = OrganMessageQueue::kLarge + 1;

OrganMeshConstPtr mesh(const std::string& organ, std::uint32_t topology, std::size_t faces) {
  const auto message = boost::make_shared<OrganMesh>();
  message->organ = organ;
  message->topology = topology;
  message->vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  for (std::size_t i = 0; i < faces; ++i) {
    message->triangles.insert(message->triangles.end(), {0, 1, 2});
  }
  return message;
}

OrganVerticesConstPtr vertices(const std::string& organ, std::uint32_t topology) {
  const auto message = boost::make_shared<OrganVertices>();
  message->organ = organ;
  message->topology = topology;
  return message;
}

/// Notes what the queue hands on. A mesh of topology n is built once `let(n)` allows it.
class OrganMessageQueueTest : public testing::Test {
 protected:
  void let(std::uint32_t topology) { allowed_[topology].set_value(); }
  /// Waits until the queue's thread has called wake() so often.
  void wait_for_wakes(int wakes) {
    while (wakes_ < wakes) std::this_thread::yield();
  }

  /// Takes all messages that are ready, in the calling thread.
  void take_all() {
    while (auto message = queue_.next()) taken_.push_back(text(*message));
  }
  /// Takes messages until so many have been taken. Does not wait for wake().
  void take_until(std::size_t messages) {
    while (taken_.size() < messages) {
      std::this_thread::yield();
      take_all();
    }
  }

  bool memory_is_short_ = false;  ///< building and waking throw std::bad_alloc
  std::vector<std::string> taken_;
  std::thread::id built_in_;
  Connection connection_;  ///< of the last mesh taken
  std::uint32_t known_ = 0;

 private:
  std::string text(OrganMessage& message) {
    if (message.vertices) {
      return message.organ() + " vertices " + std::to_string(message.vertices->topology);
    }
    connection_ = message.connection;
    const std::string text = message.organ() + " mesh " + std::to_string(message.mesh->topology);
    if (!message.built.valid()) return text;
    try {
      return text + ", " + std::to_string(message.built.get().face_count());
    } catch (const MeshError&) {
      return text + ", refused";
    } catch (const std::bad_alloc&) {
      return text + ", no memory";
    }
  }

  OrganMessageQueue::Functions functions() {
    OrganMessageQueue::Functions functions;
    functions.build = [this](const OrganMeshConstPtr& message) {
      allowed_.at(message->topology).get_future().wait();
      built_in_ = std::this_thread::get_id();
      if (memory_is_short_) throw std::bad_alloc();
      return TriangleMesh(message->vertices, message->triangles, message->topology);
    };
    functions.is_new = [this](const OrganMesh& message, const Connection&) {
      return message.topology != known_;
    };
    functions.wake = [this] {
      if (memory_is_short_) throw std::bad_alloc();
      ++wakes_;
    };
    return functions;
  }

  std::vector<std::promise<void>> allowed_ = std::vector<std::promise<void>>(300);
  std::atomic<int> wakes_{0};

 protected:
  OrganMessageQueue queue_{functions()};
};

using Texts = std::vector<std::string>;

TEST_F(OrganMessageQueueTest, SmallMeshesAndVerticesPassAtOnce) {
  queue_.add(mesh("liver", 1, OrganMessageQueue::kLarge));
  queue_.add(vertices("liver", 1));
  take_all();
  EXPECT_EQ(taken_, (Texts{"liver mesh 1", "liver vertices 1"}));
}

TEST_F(OrganMessageQueueTest, ManyVerticesMakeAMeshLargeToo) {
  const auto soup = boost::make_shared<OrganMesh>(*mesh("liver", 1, 1));
  soup->vertices.resize(3 * kFaces);
  queue_.add(OrganMeshConstPtr(soup));
  take_all();
  EXPECT_EQ(taken_, Texts{}) << "it is being built";
  let(1);
  take_until(1);
  EXPECT_EQ(taken_, Texts{"liver mesh 1, 1"});
}

TEST_F(OrganMessageQueueTest, LargeMeshesAreBuiltElsewhereAndOtherOrgansDoNotWait) {
  queue_.add(mesh("liver", 1, kFaces));
  queue_.add(vertices("liver", 1));
  queue_.add(vertices("spleen", 7));
  take_all();
  EXPECT_EQ(taken_, Texts{"spleen vertices 7"});
  let(1);
  wait_for_wakes(1);
  EXPECT_EQ(taken_.size(), 1U) << "taken in the wrong thread";
  take_all();
  EXPECT_EQ(taken_, (Texts{"spleen vertices 7", "liver mesh 1, 10001", "liver vertices 1"}));
  EXPECT_NE(built_in_, std::this_thread::get_id());
  queue_.add(vertices("liver", 1));
  take_all();
  EXPECT_EQ(taken_.back(), "liver vertices 1");
  EXPECT_EQ(taken_.size(), 4U);
}

TEST_F(OrganMessageQueueTest, TheOrderOfEachOrganStays) {
  queue_.add(mesh("liver", 1, kFaces));
  queue_.add(mesh("liver", 2, 1));
  queue_.add(vertices("liver", 2));
  queue_.add(mesh("liver", 3, kFaces));
  queue_.add(mesh("spleen", 4, kFaces));
  let(2);
  let(1);
  wait_for_wakes(1);
  take_all();
  EXPECT_EQ(taken_, (Texts{"liver mesh 1, 10001", "liver mesh 2", "liver vertices 2"}));
  let(3);
  let(4);
  wait_for_wakes(3);
  take_all();
  EXPECT_EQ(Texts(taken_.begin() + 3, taken_.end()),
            (Texts{"liver mesh 3, 10001", "spleen mesh 4, 10001"}));
}

TEST_F(OrganMessageQueueTest, AMeshIsTakenWithItsConnection) {
  const auto header = boost::make_shared<const ros::M_string>();
  queue_.add(mesh("liver", 1, kFaces), header);
  let(1);
  wait_for_wakes(1);
  take_all();
  EXPECT_EQ(connection_.lock(), header);
}

TEST_F(OrganMessageQueueTest, AKnownTopologyIsNotBuiltAgain) {
  known_ = 1;
  queue_.add(mesh("liver", 1, kFaces));
  take_all();
  EXPECT_EQ(taken_, Texts{"liver mesh 1"});
}

TEST_F(OrganMessageQueueTest, AFaultOfAMeshComesWithIt) {
  const auto bad = boost::make_shared<OrganMesh>(*mesh("liver", 1, kFaces));
  bad->triangles.back() = 3;
  queue_.add(bad);
  let(1);
  wait_for_wakes(1);
  take_all();
  EXPECT_EQ(taken_, Texts{"liver mesh 1, refused"});
}

TEST_F(OrganMessageQueueTest, AMeshThatCannotBeBuiltHoldsNothingUp) {
  memory_is_short_ = true;
  queue_.add(mesh("liver", 1, kFaces));
  queue_.add(vertices("liver", 1));
  let(1);
  take_until(2);
  EXPECT_EQ(taken_, (Texts{"liver mesh 1, no memory", "liver vertices 1"}));
  queue_.add(vertices("liver", 2));
  take_all();
  EXPECT_EQ(taken_.back(), "liver vertices 2");
}

TEST_F(OrganMessageQueueTest, SaysOfWhichOrgansMessagesWait) {
  EXPECT_FALSE(queue_.has("liver"));
  queue_.add(mesh("liver", 1, kFaces));
  queue_.add(vertices("spleen", 7));
  EXPECT_TRUE(queue_.has("liver"));
  EXPECT_TRUE(queue_.has("spleen"));
  EXPECT_FALSE(queue_.has("kidney"));
  let(1);
  take_until(2);
  EXPECT_FALSE(queue_.has("liver"));
  EXPECT_FALSE(queue_.has("spleen"));
}

TEST_F(OrganMessageQueueTest, TheOldestVerticesGoWhereTooManyWait) {
  queue_.add(mesh("liver", 1, kFaces));
  for (std::uint32_t i = 0; i < 250; ++i) queue_.add(vertices("liver", i));
  EXPECT_EQ(queue_.waiting(), OrganMessageQueue::kMostWaiting);
  EXPECT_EQ(queue_.dropped(), 251U - OrganMessageQueue::kMostWaiting);
  let(1);
  wait_for_wakes(1);
  take_all();
  ASSERT_EQ(taken_.size(), OrganMessageQueue::kMostWaiting);
  EXPECT_EQ(taken_[0], "liver mesh 1, 10001");
  EXPECT_EQ(taken_[1], "liver vertices 241");
  EXPECT_EQ(taken_.back(), "liver vertices 249");
}

TEST_F(OrganMessageQueueTest, AStreamOfEqualMeshesIsBuiltOnce) {
  for (int i = 0; i < 5; ++i) queue_.add(mesh("liver", 1, kFaces));
  let(1);
  wait_for_wakes(1);
  known_ = 1;  // The first one is applied before the others are asked about.
  take_all();
  EXPECT_EQ(taken_, (Texts{"liver mesh 1, 10001", "liver mesh 1", "liver mesh 1", "liver mesh 1",
                           "liver mesh 1"}));
}

TEST_F(OrganMessageQueueTest, OfMeshesThatComeTooFastTheNewestStay) {
  for (std::uint32_t i = 1; i <= 200; ++i) queue_.add(mesh("liver", i, kFaces));
  EXPECT_EQ(queue_.waiting(), OrganMessageQueue::kMostWaiting);
  for (std::uint32_t i = 1; i <= 200; ++i) let(i);
  take_until(OrganMessageQueue::kMostWaiting);
  EXPECT_EQ(taken_.front(), "liver mesh 1, 10001");
  EXPECT_EQ(taken_.back(), "liver mesh 200, 10001");
}

TEST_F(OrganMessageQueueTest, AMeshWithVerticesStaysAsLongAsItHasThem) {
  queue_.add(mesh("liver", 1, kFaces));
  queue_.add(mesh("liver", 2, 1));
  for (int i = 0; i < 50; ++i) queue_.add(vertices("liver", 2));
  let(1);
  wait_for_wakes(1);
  take_all();
  EXPECT_EQ(taken_[1], "liver mesh 2");
  EXPECT_EQ(taken_[2], "liver vertices 2");
}

TEST_F(OrganMessageQueueTest, TheRemovalBeforeAMeshStays) {
  const auto removal = boost::make_shared<OrganMesh>();
  removal->organ = "liver";
  queue_.add(mesh("liver", 1, kFaces));
  for (int i = 0; i < 50; ++i) {
    queue_.add(removal);
    queue_.add(mesh("liver", 2, 1));
  }
  EXPECT_EQ(queue_.waiting(), OrganMessageQueue::kMostWaiting);
  let(1);
  wait_for_wakes(1);
  take_all();
  ASSERT_GE(taken_.size(), 2U);
  EXPECT_EQ(taken_[taken_.size() - 2], "liver mesh 0") << "the removal";
  EXPECT_EQ(taken_.back(), "liver mesh 2");
}

TEST_F(OrganMessageQueueTest, EndsWhileMeshesAreStillToBeBuilt) {
  queue_.add(mesh("liver", 1, kFaces));
  queue_.add(mesh("liver", 2, kFaces));
  let(1);
  let(2);
}

}  // namespace

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
