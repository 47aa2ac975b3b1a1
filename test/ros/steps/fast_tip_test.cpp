#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

#include "node_parts.hpp"

using namespace organ_collision;

namespace {

constexpr double kRadius = 0.01;  // [m] the radius of the tool of NodeParts
constexpr double kTouch = 1e-6;   // [1] tolerance of the fraction of a step

struct Waypoint {
  double time;    // [s]
  double height;  // [m] of the tip above the sheet
};

/// A tip hovers over the sheet and, again and again, moves through it and back within 1 ms.
class FastTipTest : public testing::Test, protected NodeParts {
 protected:
  FastTipTest() { go_to(1.0, 0.05); }

  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }

  /// Sends the tip's transform at this time.
  void go_to(double time, double height) {
    way_.push_back({time, height});
    send_tip(time, {0.1, 0.2, height});
  }

  void go_through_and_back() {
    const double start = way_.back().time + uniform(2e-3, 20e-3);
    const double duration = uniform(0.2e-3, 1e-3);
    go_to(start, uniform(0.02, 0.06));
    go_to(start + uniform(0.1, 0.9) * duration, uniform(-0.02, 0.009));
    go_to(start + duration, uniform(0.02, 0.06));
  }

  /// The fraction of the step at which the tip's distance from the sheet first equals its radius,
  /// on the path that TF was given; none if it never does.
  std::optional<double> first_touch(double begin, double end) const {
    for (std::size_t i = 1; i < way_.size(); ++i) {
      const Waypoint &a = way_[i - 1], &b = way_[i];
      const double from = std::max(begin, a.time), to = std::min(end, b.time);
      if (from > to) continue;
      const double speed = (b.height - a.height) / (b.time - a.time);
      const auto height = [&](double time) { return a.height + speed * (time - a.time); };
      if (height(from) <= kRadius) return (from - begin) / (end - begin);
      if (height(to) <= kRadius) {
        return (from + (kRadius - height(from)) / speed - begin) / (end - begin);
      }
    }
    return std::nullopt;
  }

  std::mt19937 random_{7};
  std::vector<Waypoint> way_;
};

}  // namespace

TEST_F(FastTipTest, NoneOfTenThousandIsLostOrLate) {
  ros::Time::setNow(ros::Time(1000.0));
  send_mesh(1.0, 0.0);
  evaluate();
  int touches = 0, lost = 0, late = 0, invented = 0, trips = 0;
  double begin = 1.0;
  while (trips < 10'000) {
    const double end = begin + uniform(0.5e-3, 30e-3);
    for (; way_.back().time <= end; ++trips) go_through_and_back();
    send_vertices(end, 0.0);
    const auto published = evaluate();
    ASSERT_EQ(published.size(), 1u);
    ASSERT_EQ(published[0].status, ContactArray::OK) << published[0].message;
    const auto expected = first_touch(begin, end);
    const auto& contacts = published[0].contacts;
    touches += expected.has_value();
    lost += expected && contacts.empty();
    late += expected && !contacts.empty() && contacts[0].fraction > *expected + kTouch;
    invented += !contacts.empty() && (!expected || contacts[0].fraction < *expected - kTouch);
    begin = end;
    way_.erase(way_.begin(), way_.end() - std::min<std::ptrdiff_t>(way_.size(), 20));
  }
  EXPECT_GT(touches, 5'000);
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(late, 0);
  EXPECT_EQ(invented, 0);
}
