#include "ros/organs/organ_message_queue.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <boost/make_shared.hpp>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

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
