#include "ros/queries/batch_workers.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "ros/messages/failure_log.hpp"

using namespace organ_collision;

namespace {

/// The result of wait() in another thread.
std::future<bool> waits(AnswerBudget& budget, std::size_t block) {
  return std::async(std::launch::async, [&budget, block] { return budget.wait(block, 0); });
}

bool is_waiting(std::future<bool>& result) {
  return result.wait_for(std::chrono::milliseconds(20)) == std::future_status::timeout;
}

}  // namespace

TEST(AnswerBudget, WithinTheBoundNobodyWaits) {
  AnswerBudget budget(100);
  budget.add(60);
  budget.add(40);
  for (std::size_t block = 0; block < 5; ++block) EXPECT_TRUE(budget.wait(block, 0));
}

TEST(AnswerBudget, AboveTheBoundBlocksGoOnInTheirOrder) {
  AnswerBudget budget(100);
  budget.add(101);
  EXPECT_TRUE(budget.wait(0, 0));
  std::future<bool> first = waits(budget, 1), second = waits(budget, 2);
  EXPECT_TRUE(is_waiting(first));
  budget.set_taken(0, 50);
  EXPECT_TRUE(first.get());
  EXPECT_TRUE(is_waiting(second));
  budget.set_taken(1, 60);
  EXPECT_TRUE(second.get());
}

TEST(AnswerBudget, ABlockStopsIfTheBatchExceedsTheBoundWithIt) {
  AnswerBudget budget(100);
  budget.add(90);
  budget.set_taken(0, 80);
  EXPECT_TRUE(budget.wait(1, 21));  // All answers so far are within the bound.
  budget.add(20);
  EXPECT_TRUE(budget.wait(1, 20));
  EXPECT_FALSE(budget.wait(1, 21));
}

TEST(AnswerBudget, TheEndEndsAllWaits) {
  AnswerBudget budget(0);
  budget.add(1);
  std::future<bool> waiting = waits(budget, 3);
  EXPECT_TRUE(is_waiting(waiting));
  budget.end();
  EXPECT_FALSE(waiting.get());
  EXPECT_FALSE(budget.wait(0, 0));
}

namespace organ_collision {

/// Batches over a sheet, which is 2 m wide and has 800 faces.
class BatchTest : public testing::Test {
 protected:
  BatchTest() {
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

  /// Shafts that go from heights in [0.01, 0.3] to heights in [low, 0.3].
  void add_random_shafts(std::size_t count, double low) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.8, 0.8), from(0.05, 0.3), to(low, 0.3);
    for (std::size_t i = 0; i < count; ++i) {
      ToolMotion& motion = request_.motions.emplace_back();
      const auto point = [&](double z) {
        const double x = place(random), y = place(random);
        return tf2::toMsg(Eigen::Vector3d(x, y, z));
      };
      motion.trocar = motion.previous_trocar = point(1.0);
      motion.previous_tip = point(from(random));
      motion.tip = point(to(random));
      motion.radius = i % 7 == 3 ? 0.0 : 0.01;  // Some are illegal.
    }
  }

  CheckedBatch batch() const {
    return {request_, request_.motions.size(), snapshot_, collision_, unanswered_, most_bytes_};
  }

  QuerySnapshot snapshot_;
  QueryCollisionBatch::Request request_;
  CollisionRequest collision_;
  ContactArray unanswered_;
  std::size_t most_bytes_ = 1'000'000'000;
};

}  // namespace organ_collision

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

class BatchAnswersTest : public BatchTest {
 protected:
  /// The numbers of the blocks, in their order.
  static std::vector<std::size_t> blocks_of(const BatchAnswers& answers) {
    std::vector<std::size_t> blocks(answers.blocks());
    std::iota(blocks.begin(), blocks.end(), 0);
    return blocks;
  }

  /// The answers if the blocks are evaluated in this order.
  std::vector<ContactArray> answers_of(const std::vector<std::size_t>& order) {
    const CheckedBatch checked = batch();
    BatchAnswers answers(checked, ended_);
    for (const std::size_t block : order) answers.evaluate(block, query_);
    for (std::size_t block = 0; block < answers.blocks(); ++block) answers.take(block);
    return answers.all();
  }

  /// Replaces a motion by one that touches.
  void touch_in(std::size_t motion) {
    request_.motions[motion].radius = 0.01;
    request_.motions[motion].tip = tf2::toMsg(Vector3d(0.1, 0.2, -0.3));
  }

  ContactQuery query_{PickerKind::kFeedback};
  std::atomic<bool> ended_{false};
};

}  // namespace

TEST_F(BatchAnswersTest, TheOrderOfEvaluationChangesNothing) {
  add_random_shafts(100, -0.3);
  const CheckedBatch checked = batch();
  std::vector<std::size_t> order = blocks_of(BatchAnswers(checked, ended_));
  ASSERT_GT(order.size(), 3u);
  std::mt19937 random(3);
  for (const bool stops : {false, true}) {
    request_.stop_at_first_contact = stops;
    std::sort(order.begin(), order.end());
    const std::vector<ContactArray> expected = answers_of(order);
    for (int i = 0; i < 5; ++i) {
      std::shuffle(order.begin(), order.end(), random);
      EXPECT_EQ(answers_of(order), expected);
    }
  }
}

TEST_F(BatchAnswersTest, AnEarlierContactThatIsFoundLaterEndsTheAnswers) {
  add_random_shafts(64, 0.05);
  touch_in(7);
  touch_in(63);
  request_.stop_at_first_contact = 1;
  const CheckedBatch checked = batch();
  BatchAnswers answers(checked, ended_);
  const std::size_t last = answers.blocks() - 1;
  for (std::size_t block = last; block <= last; --block) answers.evaluate(block, query_);
  EXPECT_EQ(answers.take(0), 8u);
  for (std::size_t block = 1; block <= last; ++block) EXPECT_EQ(answers.take(block), 0u);
  const std::vector<ContactArray> all = answers.all();
  ASSERT_EQ(all.size(), 8u);
  EXPECT_FALSE(all.back().contacts.empty());
}

TEST_F(BatchAnswersTest, NoBlockWaitsAfterARefusal) {
  add_random_shafts(64, 0.05);
  most_bytes_ = 1;
  const CheckedBatch checked = batch();
  BatchAnswers answers(checked, ended_);
  answers.evaluate(0, query_);
  EXPECT_THROW(answers.take(0), Rejection);
  answers.evaluate(1, query_);  // Would wait for ever.
}

TEST_F(BatchAnswersTest, NothingIsTakenAfterTheEnd) {
  add_random_shafts(64, 0.05);
  const CheckedBatch checked = batch();
  BatchAnswers answers(checked, ended_);
  answers.evaluate(0, query_);
  ended_ = true;
  answers.evaluate(1, query_);
  EXPECT_THROW(answers.take(0), std::runtime_error);
}

using namespace organ_collision;

namespace {

class BatchWorkersTest : public BatchTest {
 protected:
  std::vector<ContactArray> answers(int threads) {
    return BatchWorkers(PickerKind::kFeedback, threads, statistics_).answer(batch());
  }

  std::vector<ContactArray> answers_one_by_one() {
    std::vector<ContactArray> all;
    QueryCollisionBatch::Request one = request_;
    BatchWorkers workers(PickerKind::kFeedback, 1, statistics_);
    for (const ToolMotion& motion : request_.motions) {
      one.motions = {motion};
      all.push_back(
          workers.answer({one, 1, snapshot_, collision_, unanswered_, most_bytes_}).at(0));
    }
    return all;
  }

  ServiceStatistics statistics_;
};

}  // namespace

TEST_F(BatchWorkersTest, TheNumberOfThreadsChangesNothing) {
  add_random_shafts(203, -0.3);
  const std::vector<ContactArray> expected = answers_one_by_one();
  ASSERT_EQ(expected.size(), 203u);
  EXPECT_GT(expected[0].contacts.size() + expected[1].contacts.size(), 0u);
  EXPECT_EQ(expected[3].status, ContactArray::INVALID_REQUEST);
  for (const int threads : {1, 2, 5, 0}) EXPECT_EQ(answers(threads), expected) << threads;
}

TEST_F(BatchWorkersTest, EndsWithTheFirstMotionThatTouches) {
  add_random_shafts(200, 0.05);
  for (const std::size_t touching : {0u, 15u, 16u, 87u, 199u}) {
    const ToolMotion before = request_.motions[touching];
    request_.motions[touching].radius = 0.01;
    request_.motions[touching].tip = tf2::toMsg(Vector3d(0.1, 0.2, -0.3));
    // A later one touches, too.
    const ToolMotion last = request_.motions.back();
    request_.motions.back() = request_.motions[touching];
    request_.stop_at_first_contact = 0;
    std::vector<ContactArray> expected = answers(2);
    for (std::size_t i = 0; i < touching; ++i) ASSERT_TRUE(expected[i].contacts.empty());
    ASSERT_FALSE(expected[touching].contacts.empty());
    expected.resize(touching + 1);
    request_.stop_at_first_contact = 1;
    for (const int threads : {1, 2, 5}) {
      EXPECT_EQ(answers(threads), expected) << touching << ", " << threads;
    }
    request_.motions.back() = last;
    request_.motions[touching] = before;
  }
  EXPECT_EQ(answers(2).size(), 200u);  // None touches.
}

TEST_F(BatchWorkersTest, MotionsAfterTheFirstContactAreNotEvaluated) {
  add_random_shafts(1, -0.3);
  ASSERT_FALSE(answers_one_by_one().at(0).contacts.empty());
  request_.motions.assign(200'000, request_.motions[0]);
  request_.stop_at_first_contact = 1;
  // All answers together would have more bytes.
  most_bytes_ = 1'000'000;
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
  const std::vector<ContactArray> expected = answers(2);
  ASSERT_EQ(expected.size(), 200u);
  ToolMotion touching = request_.motions[0];
  touching.tip = tf2::toMsg(Vector3d(0.1, 0.2, -0.3));
  request_.motions.push_back(touching);
  touching.radius = 0.5;  // So many contacts that one answer is too large.
  request_.motions.insert(request_.motions.end(), 100, touching);
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
  ToolMotion touching = request_.motions[0];
  touching.tip = tf2::toMsg(Vector3d(0.1, 0.2, -0.3));
  request_.motions.insert(request_.motions.begin() + 40, touching);
  answers(2);
  EXPECT_EQ(statistics_.summary().batches, 1u);
  EXPECT_EQ(statistics_.summary().motions, 101u);
  request_.stop_at_first_contact = 1;
  answers(2);
  EXPECT_EQ(statistics_.summary().batches, 2u);
  EXPECT_EQ(statistics_.summary().motions, 142u);
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
