#include "ros/queries/batch_workers.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "ros/messages/failure_log.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

/// Batches over a sheet, which is 2 m wide and has 800 faces.
class BatchWorkersTest : public testing::Test {
 protected:
  BatchWorkersTest() {
    snapshot_.latest.mesh = std::make_shared<const TriangleMesh>(sheet());
    request_.mode = ContactArray::SWEPT;
    collision_.organ = snapshot_.latest.mesh.get();
    collision_.mode = QueryMode::kSwept;
    unanswered_.organ = "liver";
  }

  static TriangleMesh sheet() {
    constexpr std::uint32_t kCells = 20;
    std::vector<float> vertices;
    std::vector<std::uint32_t> faces;
    std::mt19937 random(11);
    std::uniform_real_distribution<float> height(-0.02f, 0.02f);
    for (std::uint32_t y = 0; y <= kCells; ++y) {
      for (std::uint32_t x = 0; x <= kCells; ++x) {
        const float step = 2.0f / kCells;
        vertices.insert(vertices.end(), {-1.0f + step * static_cast<float>(x),
                                         -1.0f + step * static_cast<float>(y), height(random)});
        if (x == kCells || y == kCells) continue;
        const std::uint32_t a = y * (kCells + 1) + x, b = a + kCells + 1;
        faces.insert(faces.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
    }
    return {vertices, faces};
  }

  /// Shafts that go from heights in [0.05, 0.3] to heights in [low, 0.3].
  void add_random_shafts(std::size_t count, double low) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.8, 0.8), from(0.05, 0.3), to(low, 0.3);
    for (std::size_t i = 0; i < count; ++i) {
      ToolMotion& motion = request_.motions.emplace_back();
      const auto point = [&](double z) {
        const double x = place(random), y = place(random);
        return tf2::toMsg(Vector3d(x, y, z));
      };
      motion.trocar = motion.previous_trocar = point(1.0);
      motion.previous_tip = point(from(random));
      motion.tip = point(to(random));
      motion.radius = i % 7 == 3 ? 0.0 : 0.01;  // Some are illegal.
    }
  }

  /// A motion that touches.
  ToolMotion touching() const {
    ToolMotion motion = request_.motions[0];
    motion.radius = 0.01;
    motion.tip = tf2::toMsg(Vector3d(0.1, 0.2, -0.3));
    return motion;
  }

  CheckedBatch batch() const {
    return {request_, request_.motions.size(), snapshot_, collision_, unanswered_, most_bytes_};
  }

  std::vector<ContactArray> answers(int threads) {
    return BatchWorkers(PickerKind::kFeedback, threads, statistics_).answer(batch());
  }

  QuerySnapshot snapshot_;
  QueryCollisionBatch::Request request_;
  CollisionRequest collision_;
  ContactArray unanswered_;
  std::size_t most_bytes_ = 1'000'000'000;
  ServiceStatistics statistics_;
};

}  // namespace

TEST_F(BatchWorkersTest, TheNumberOfThreadsChangesNothing) {
  add_random_shafts(203, -0.3);
  std::vector<ContactArray> expected;
  BatchWorkers workers(PickerKind::kFeedback, 1, statistics_);
  QueryCollisionBatch::Request one = request_;
  for (const ToolMotion& motion : request_.motions) {
    one.motions = {motion};
    expected.push_back(
        workers.answer({one, 1, snapshot_, collision_, unanswered_, most_bytes_}).at(0));
  }
  EXPECT_GT(expected[0].contacts.size() + expected[1].contacts.size(), 0u);
  EXPECT_EQ(expected[3].status, ContactArray::INVALID_REQUEST);
  for (const int threads : {1, 2, 5, 0}) EXPECT_EQ(answers(threads), expected) << threads;
}

TEST_F(BatchWorkersTest, EndsWithTheFirstMotionThatTouches) {
  add_random_shafts(200, 0.05);
  for (const std::size_t first : {0u, 15u, 87u, 199u}) {
    const ToolMotion before = request_.motions[first], last = request_.motions.back();
    request_.motions[first] = request_.motions.back() = touching();
    request_.stop_at_first_contact = 0;
    std::vector<ContactArray> expected = answers(2);
    for (std::size_t i = 0; i < first; ++i) ASSERT_TRUE(expected[i].contacts.empty());
    ASSERT_FALSE(expected[first].contacts.empty());
    expected.resize(first + 1);
    request_.stop_at_first_contact = 1;
    for (const int threads : {1, 2, 5}) {
      EXPECT_EQ(answers(threads), expected) << first << ", " << threads;
    }
    request_.motions.back() = last;
    request_.motions[first] = before;
  }
  EXPECT_EQ(answers(2).size(), 200u);  // None touches.
}

TEST_F(BatchWorkersTest, MotionsAfterTheFirstContactAreNotEvaluated) {
  add_random_shafts(1, -0.3);
  request_.motions.assign(200'000, touching());
  request_.stop_at_first_contact = 1;
  EXPECT_EQ(answers(2).size(), 1u);
}

TEST_F(BatchWorkersTest, TooManyBytesAreRefusedWithTheSameWords) {
  add_random_shafts(300, -0.3);
  for (ToolMotion& motion : request_.motions) motion.radius = 0.3;  // Hundreds of contacts.
  most_bytes_ = 100'000;
  std::string first;
  for (const int threads : {1, 2, 5}) {
    try {
      answers(threads);
      FAIL() << "not refused";
    } catch (const Rejection& rejection) {
      if (first.empty()) first = rejection.what();
      EXPECT_EQ(rejection.what(), first) << threads;
      EXPECT_NE(first.find("of 300 motions"), std::string::npos) << first;
      EXPECT_NE(first.find("max_batch_bytes"), std::string::npos) << first;
    }
  }
}

TEST_F(BatchWorkersTest, BytesAfterTheFirstContactDoNotCount) {
  add_random_shafts(200, 0.05);
  most_bytes_ = 400'000;
  ASSERT_EQ(answers(2).size(), 200u);
  ToolMotion wide = touching();
  wide.radius = 0.5;  // So many contacts that one answer is too large.
  request_.motions.push_back(touching());
  request_.motions.insert(request_.motions.end(), 100, wide);
  request_.stop_at_first_contact = 1;
  for (const int threads : {1, 2, 5}) {
    const std::vector<ContactArray> found = answers(threads);
    ASSERT_EQ(found.size(), 201u) << threads;
    EXPECT_FALSE(found.back().contacts.empty());
  }
  request_.stop_at_first_contact = 0;
  EXPECT_THROW(answers(2), Rejection);
}

TEST_F(BatchWorkersTest, CountsTheMotionsThatAreAnswered) {
  add_random_shafts(100, 0.05);
  request_.motions.insert(request_.motions.begin() + 40, touching());
  answers(2);
  EXPECT_EQ(statistics_.counts().batches, 1u);
  EXPECT_EQ(statistics_.counts().motions, 101u);
  request_.stop_at_first_contact = 1;
  answers(2);
  EXPECT_EQ(statistics_.counts().batches, 2u);
  EXPECT_EQ(statistics_.counts().motions, 142u);
}

TEST_F(BatchWorkersTest, EndsSoonWhenAsked) {
  add_random_shafts(1, 0.05);
  request_.motions.assign(500'000, request_.motions[0]);
  BatchWorkers workers(PickerKind::kFeedback, 2, statistics_);
  auto answering = std::async(std::launch::async, [&] { return workers.answer(batch()); });
  EXPECT_EQ(answering.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout);
  workers.end();
  EXPECT_THROW(answering.get(), std::runtime_error);
  EXPECT_THROW(workers.answer(batch()), std::runtime_error);
}
