// Short runs of proxy_proof: the proxy never passes through tissue, never comes too near, and is
// never overrun.
#include <gtest/gtest.h>

#include "test/proof/proxy/episode.hpp"
#include "test/proof/proxy/scenes.hpp"

namespace organ_collision {
namespace {

class NeverThrough : public testing::TestWithParam<std::string> {};

TEST_P(NeverThrough, WhateverTheHandDoes) {
  const oracle::ProxyTally tally = oracle::follow_hand(
      {GetParam(), 7, 0}, 2000,
      [](long tick, const std::string& what) { ADD_FAILURE() << "tick " << tick << ": " << what; });
  EXPECT_EQ(tally.broken(), 0);
  EXPECT_EQ(tally.ticks, 2000);
}

INSTANTIATE_TEST_SUITE_P(Scenes, NeverThrough, testing::ValuesIn(oracle::proxy_scene_kinds()),
                         [](const auto& kind) {
                           std::string name = kind.param;
                           for (char& c : name) c = c == ' ' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace organ_collision
