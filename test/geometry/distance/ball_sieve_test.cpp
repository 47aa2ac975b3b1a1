#include "geometry/distance/ball_sieve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

struct Ball {
  Vector3d center;
  double radius;
};

/// A sieve with all of `balls`.
BallSieve sieve_with(const std::vector<Ball>& balls, const Vector3d& origin) {
  BallSieve sieve;
  sieve.clear(origin);
  for (const Ball& ball : balls) sieve.add(ball.center, ball.radius);
  return sieve;
}

/// The numbers of the balls in a range, in its order.
std::vector<std::uint32_t> numbers(const BallSieve& sieve, const BallSieve::Range& range) {
  std::vector<std::uint32_t> listed;
  for (std::size_t place = range.begin; place < range.end; ++place) {
    listed.push_back(sieve.number(place));
  }
  return listed;
}

/// [m] How far a ball stays from a box, along the direction along which that is farthest. Negative
/// if it meets all three intervals.
double gap(const Ball& ball, const Slabs& box) {
  const Vector3d along = box.axes.transpose() * ball.center;
  return (along - box.high).cwiseMax(box.low - along).maxCoeff() - ball.radius;
}

/// A box of any size near `middle`.
Slabs random_box(const Vector3d& middle, Random& random) {
  Slabs box;
  box.axes = oracle::random_pose(1.0, random).linear();
  const Vector3d center = box.axes.transpose() * (middle + random.point(0.02));
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double half_size = random.chance(0.2) ? 0.0 : random.uniform(0.0, 0.2);
    box.low[i] = center[i] - half_size;
    box.high[i] = center[i] + half_size;
  }
  return box;
}

/// Balls around `middle`; some of them graze the box.
std::vector<Ball> random_balls(int count, const Vector3d& middle, const Slabs& box,
                               Random& random) {
  std::vector<Ball> balls;
  for (int i = 0; i < count; ++i) {
    Ball ball{middle + random.point(0.1), random.chance(0.1) ? 0.0 : random.scale(1e-5, 0.1)};
    if (random.chance(0.3)) {
      const Eigen::Index axis = random.integer(0, 2);
      ball.center +=
          (box.high[axis] + ball.radius - box.axes.col(axis).dot(ball.center)) * box.axes.col(axis);
    }
    balls.push_back(ball);
  }
  return balls;
}

// Near the origin and far from it, no ball that meets the box is missing, and none that is clearly
// away from it is listed.
TEST(BallSieve, ListsTheBallsThatMeetABox) {
  Random random(1);
  int met = 0, grazed = 0;
  for (int i = 0; i < 5000; ++i) {
    const double away = random.chance(0.5) ? 0.0 : random.scale(1e-2, 1e3);
    const Vector3d middle = random.point(1.0), origin = middle + away * random.direction();
    const Slabs box = random_box(middle, random);
    const std::vector<Ball> balls = random_balls(random.integer(0, 20), middle, box, random);
    BallSieve sieve = sieve_with(balls, origin);
    const auto listed = numbers(sieve, sieve.sift(sieve.all(), box));
    ASSERT_TRUE(std::is_sorted(listed.begin(), listed.end()));
    const double rounding = 1e-5 * (1.0 + away);
    for (std::uint32_t number = 0; number < balls.size(); ++number) {
      const bool is_listed = std::binary_search(listed.begin(), listed.end(), number);
      const double away_from_box = gap(balls[number], box);
      ASSERT_TRUE(is_listed || away_from_box > 0.0);
      ASSERT_TRUE(!is_listed || away_from_box <= rounding);
      met += static_cast<int>(away_from_box <= 0.0);
      grazed += static_cast<int>(std::abs(away_from_box) < 1e-15);
    }
  }
  EXPECT_GT(met, 5000);
  EXPECT_GT(grazed, 1000);
}

// A tree sifts what it has sifted before, and comes back to the list above.
TEST(BallSieve, SiftsItsOwnRangesAndForgetsThem) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Slabs large = random_box(Vector3d::Zero(), random);
    const Slabs small = random_box(Vector3d::Zero(), random);
    const std::vector<Ball> balls =
        random_balls(random.integer(0, 50), Vector3d::Zero(), large, random);
    BallSieve sieve = sieve_with(balls, Vector3d::Zero());
    const BallSieve::Range in_large = sieve.sift(sieve.all(), large);
    const auto of_large = numbers(sieve, in_large);
    BallSieve::Range in_both = sieve.sift(in_large, small);
    std::vector<std::uint32_t> expected;
    const auto of_small = numbers(sieve, sieve.sift(sieve.all(), small));
    std::set_intersection(of_large.begin(), of_large.end(), of_small.begin(), of_small.end(),
                          std::back_inserter(expected));
    ASSERT_EQ(numbers(sieve, in_both), expected);
    sieve.forget(in_both);
    ASSERT_EQ(numbers(sieve, in_large), of_large);
    in_both = sieve.sift(in_large, small);
    ASSERT_EQ(numbers(sieve, in_both), expected);
  }
}

TEST(BallSieve, LeavesOutWhatIsRemovedOrNotKept) {
  const std::vector<Ball> balls(7, {Vector3d::Zero(), 0.1});
  const Slabs box{Eigen::Matrix3d::Identity(), Vector3d::Zero(), Vector3d::Ones()};
  BallSieve sieve = sieve_with(balls, Vector3d::Zero());
  sieve.remove(2);
  sieve.remove(6);
  BallSieve::Range range = sieve.sift(sieve.all(), box);
  EXPECT_EQ(numbers(sieve, range), (std::vector<std::uint32_t>{0, 1, 3, 4, 5}));
  sieve.keep_if(range, [](std::uint32_t number) { return number % 2 == 1; });
  EXPECT_EQ(numbers(sieve, range), (std::vector<std::uint32_t>{1, 3, 5}));
  EXPECT_EQ(sieve.sift(range, box).size(), 3U);
  sieve.clear(Vector3d::Zero());
  EXPECT_TRUE(sieve.all().empty());
}

}  // namespace
}  // namespace organ_collision
