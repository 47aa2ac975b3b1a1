#include "ros/queries/batch_answers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <stdexcept>

#include "batch_fixture.hpp"
#include "ros/interface/rejection.hpp"

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
