#include "replay/replay_options.hpp"

#include <gtest/gtest.h>

#include "offline/input_error.hpp"

using namespace organ_collision;

TEST(ReplayOptions, Defaults) {
  const ReplayOptions options = parse_replay_options({"a.bag", "--parameters", "t.yaml", "b.bag"});
  EXPECT_EQ(options.in, "a.bag");
  EXPECT_EQ(options.out, "b.bag");
  EXPECT_EQ(options.parameters, "t.yaml");
  EXPECT_EQ(options.node, "/organ_collision");
  EXPECT_FALSE(options.with_input);
  EXPECT_FALSE(options.help);
}

TEST(ReplayOptions, AllOptions) {
  const ReplayOptions options = parse_replay_options(
      {"--with-input", "--parameters=t.yaml", "--node=left/contacts", "a.bag", "b.bag"});
  EXPECT_EQ(options.node, "/left/contacts");
  EXPECT_TRUE(options.with_input);
}

TEST(ReplayOptions, HelpNeedsNothingElse) {
  EXPECT_TRUE(parse_replay_options({"--nonsense", "--help"}).help);
}

TEST(ReplayOptions, RefusesOthers) {
  using Words = std::vector<std::string>;
  for (const Words& words :
       {Words{}, Words{"a.bag", "b.bag"}, Words{"--parameters", "t.yaml", "a.bag"},
        Words{"a.bag", "b.bag", "--parameters"}, Words{"a.bag", "b.bag", "--parameters="},
        Words{"--with-input=1", "--parameters=t", "a.bag", "b.bag"},
        Words{"--parameters=t", "--parameters=t", "a.bag", "b.bag"},
        Words{"--node=1/2", "--parameters=t", "a.bag", "b.bag"},
        Words{"--node=~x", "--parameters=t", "a.bag", "b.bag"}}) {
    EXPECT_THROW(parse_replay_options(words), InputError) << testing::PrintToString(words);
  }
}
