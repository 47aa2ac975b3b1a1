#include "demo/proxy_tally.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

ProxyState state(std::uint8_t value, double force) {
  ProxyState state;
  state.state = value;
  state.wrench.force.y = -force;
  state.tick_sec = 30e-6;
  return state;
}

TEST(ProxyTally, TellsTheLatestStateAndTheGreatestForceOfALine) {
  ProxyTally tally;
  tally.add(state(ProxyState::FREE, 0.0));
  tally.add(state(ProxyState::TOUCHING, 1.24));
  tally.add(state(ProxyState::TOUCHING, 0.6));
  EXPECT_EQ(tally.take_line(0.5), "TOUCHING, up to 1.2 N, 6 poses/s");
  tally.add(state(ProxyState::FREE, 0.0));
  EXPECT_EQ(tally.take_line(0.5), "FREE, up to 0.0 N, 2 poses/s");
}

TEST(ProxyTally, TellsWhyThereIsNoAnswer) {
  ProxyTally tally;
  EXPECT_EQ(tally.answered(), 0U);
  ProxyState lost = state(ProxyState::NO_ANSWER, 0.3);
  lost.message = "there is no organ";
  tally.add(lost);
  EXPECT_EQ(tally.take_line(1.0), "NO_ANSWER: there is no organ");
  EXPECT_EQ(tally.answered(), 0U);
}

TEST(ProxyTally, SumsUpAllLines) {
  ProxyTally tally;
  EXPECT_EQ(tally.summary(),
            "0 poses, tissue held the proxy in 0% of them, with at most 0.0 N; 0 us a tick on "
            "average");
  for (int i = 0; i < 4; ++i) {
    tally.add(state(i == 0 ? ProxyState::FREE : ProxyState::TOUCHING, 0.5 * i));
    tally.take_line(1.0);
  }
  EXPECT_EQ(tally.summary(),
            "4 poses, tissue held the proxy in 75% of them, with at most 1.5 N; 30 us a tick on "
            "average");
}

}  // namespace
}  // namespace organ_collision
