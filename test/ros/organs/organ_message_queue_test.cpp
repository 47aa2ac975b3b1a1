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

/// Notes what the inbox hands on. A mesh of topology n is made when `let(n)` allows it.
class OrganMessageQueueTest : public testing::Test {
 protected:
  void let(std::uint32_t topology) { allowed_[topology].set_value(); }
  /// Until the inbox's thread has called so often.
  void wait_for_wakes(int wakes) {
    while (wakes_ < wakes) std::this_thread::yield();
  }

  /// Whether it was called or not.
  void hand_on_until_taken(std::size_t messages) {
    while (taken_.size() < messages) {
      std::this_thread::yield();
      inbox_.hand_on();
    }
  }

  bool memory_is_short_ = false;  ///< for making, and for waking
  std::vector<std::string> taken_;
  std::thread::id made_in_;
  Connection connection_;  ///< of the last mesh taken
  std::uint32_t known_ = 0;

 private:
  OrganMessageQueue::Callbacks callbacks() {
    OrganMessageQueue::Callbacks callbacks;
    callbacks.make = [this](const OrganMeshConstPtr& message) {
      allowed_.at(message->topology).get_future().wait();
      made_in_ = std::this_thread::get_id();
      if (memory_is_short_) throw std::bad_alloc();
      return TriangleMesh(message->vertices, message->triangles, message->topology);
    };
    callbacks.is_known = [this](const OrganMesh& message, const Connection&) {
      return message.topology == known_;
    };
    callbacks.take = [this](const OrganMeshConstPtr& message, const Connection& connection,
                            const auto& made) {
      connection_ = connection;
      std::string text = message->organ + " mesh " + std::to_string(message->topology);
      if (message->topology != known_) {
        try {
          text += ", " + std::to_string(made().face_count());
        } catch (const MeshError&) {
          text += ", refused";
        }
      }
      taken_.push_back(text);
    };
    callbacks.take_vertices = [this](const OrganVerticesConstPtr& message) {
      taken_.push_back(message->organ + " vertices " + std::to_string(message->topology));
    };
    callbacks.wake = [this] {
      if (memory_is_short_) throw std::bad_alloc();
      ++wakes_;
    };
    return callbacks;
  }

  std::vector<std::promise<void>> allowed_ = std::vector<std::promise<void>>(300);
  std::atomic<int> wakes_{0};

 protected:
  OrganMessageQueue inbox_{callbacks()};
};

using Texts = std::vector<std::string>;

TEST_F(OrganMessageQueueTest, SmallMeshesAndVerticesPassAtOnce) {
  let(1);
  inbox_.add(mesh("liver", 1, OrganMessageQueue::kLarge));
  EXPECT_EQ(made_in_, std::this_thread::get_id());
  inbox_.add(vertices("liver", 1));
  EXPECT_EQ(taken_, (Texts{"liver mesh 1, 10000", "liver vertices 1"}));
}

TEST_F(OrganMessageQueueTest, LargeMeshesAreMadeElsewhereAndOtherOrgansDoNotWait) {
  inbox_.add(mesh("liver", 1, kFaces));
  inbox_.add(vertices("liver", 1));
  inbox_.add(vertices("spleen", 7));
  inbox_.hand_on();
  EXPECT_EQ(taken_, Texts{"spleen vertices 7"});
  let(1);
  wait_for_wakes(1);
  EXPECT_EQ(taken_.size(), 1U) << "handed on in the wrong thread";
  inbox_.hand_on();
  EXPECT_EQ(taken_, (Texts{"spleen vertices 7", "liver mesh 1, 10001", "liver vertices 1"}));
  EXPECT_NE(made_in_, std::this_thread::get_id());
  inbox_.add(vertices("liver", 1));
  EXPECT_EQ(taken_.back(), "liver vertices 1");
  EXPECT_EQ(taken_.size(), 4U);
}

TEST_F(OrganMessageQueueTest, TheOrderOfEachOrganStays) {
  inbox_.add(mesh("liver", 1, kFaces));
  inbox_.add(mesh("liver", 2, 1));
  inbox_.add(vertices("liver", 2));
  inbox_.add(mesh("liver", 3, kFaces));
  inbox_.add(mesh("spleen", 4, kFaces));
  let(2);
  let(1);
  wait_for_wakes(1);
  inbox_.hand_on();
  EXPECT_EQ(taken_, (Texts{"liver mesh 1, 10001", "liver mesh 2, 1", "liver vertices 2"}));
  let(3);
  let(4);
  wait_for_wakes(3);
  inbox_.hand_on();
  EXPECT_EQ(Texts(taken_.begin() + 3, taken_.end()),
            (Texts{"liver mesh 3, 10001", "spleen mesh 4, 10001"}));
}

TEST_F(OrganMessageQueueTest, AMeshIsTakenWithItsConnection) {
  const auto header = boost::make_shared<const ros::M_string>();
  inbox_.add(mesh("liver", 1, kFaces), header);
  let(1);
  wait_for_wakes(1);
  inbox_.hand_on();
  EXPECT_EQ(connection_.lock(), header);
}

TEST_F(OrganMessageQueueTest, AKnownTopologyIsNotMadeAgain) {
  known_ = 1;
  inbox_.add(mesh("liver", 1, kFaces));
  EXPECT_EQ(taken_, Texts{"liver mesh 1"});
}

TEST_F(OrganMessageQueueTest, WhatIsWrongWithAMeshComesWithIt) {
  const auto bad = boost::make_shared<OrganMesh>(*mesh("liver", 1, kFaces));
  bad->triangles.back() = 3;
  inbox_.add(bad);
  let(1);
  wait_for_wakes(1);
  inbox_.hand_on();
  EXPECT_EQ(taken_, Texts{"liver mesh 1, refused"});
}

TEST_F(OrganMessageQueueTest, WhatCannotBeMadeHoldsNothingUp) {
  memory_is_short_ = true;
  inbox_.add(mesh("liver", 1, kFaces));
  inbox_.add(vertices("liver", 1));
  let(1);
  EXPECT_THROW(hand_on_until_taken(1), std::bad_alloc);
  inbox_.hand_on();
  EXPECT_EQ(taken_, Texts{"liver vertices 1"});
  inbox_.add(vertices("liver", 2));
  EXPECT_EQ(taken_.back(), "liver vertices 2");
}

TEST_F(OrganMessageQueueTest, TheOldestVerticesGoWhereTooManyWait) {
  inbox_.add(mesh("liver", 1, kFaces));
  for (std::uint32_t i = 0; i < 250; ++i) inbox_.add(vertices("liver", i));
  let(1);
  wait_for_wakes(1);
  inbox_.hand_on();
  ASSERT_EQ(taken_.size(), OrganMessageQueue::kMostWaiting);
  EXPECT_EQ(taken_[0], "liver mesh 1, 10001");
  EXPECT_EQ(taken_[1], "liver vertices 151");
  EXPECT_EQ(taken_.back(), "liver vertices 249");
}

TEST_F(OrganMessageQueueTest, EndsWhileMeshesAreStillToBeMade) {
  inbox_.add(mesh("liver", 1, kFaces));
  inbox_.add(mesh("liver", 2, kFaces));
  let(1);
  let(2);
}

}  // namespace
