#include "check_options.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace organ_collision {
namespace {

using Words = std::vector<std::string>;

TEST(CheckOptionsTest, WatchesTheNodesContactsByDefault) {
  const CheckOptions options = parse_check_options({});
  EXPECT_EQ(options.topics, Words{"organ_collision/contacts"});
  EXPECT_FALSE(options.seconds);
  EXPECT_FALSE(options.help);
}

TEST(CheckOptionsTest, TakesTopicsAndSeconds) {
  const CheckOptions options = parse_check_options({"/a/contacts", "--seconds", "2.5", "b"});
  EXPECT_EQ(options.topics, (Words{"/a/contacts", "b"}));
  EXPECT_EQ(options.seconds, 2.5);
  EXPECT_TRUE(parse_check_options({"-h"}).help);
}

TEST(CheckOptionsTest, RefusesAnythingElse) {
  for (const Words& words :
       {Words{"--second", "2"}, Words{"--seconds"}, Words{"--seconds", "x"}, Words{"--seconds", ""},
        Words{"--seconds", "0"}, Words{"--seconds", "nan"}, Words{"--seconds", "inf"}}) {
    EXPECT_THROW(parse_check_options(words), std::invalid_argument) << words.back();
  }
}

}  // namespace
}  // namespace organ_collision
