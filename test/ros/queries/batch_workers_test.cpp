#include "ros/queries/batch_workers.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <stdexcept>
#include <string>

#include "batch_fixture.hpp"
#include "ros/interface/rejection.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

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
