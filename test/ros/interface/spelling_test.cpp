#include "ros/interface/spelling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace organ_collision;

namespace {

/// By definition: the least of three recursive ways.
std::size_t distance_oracle(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const std::string a_rest = a.substr(1), b_rest = b.substr(1);
  return std::min({distance_oracle(a_rest, b) + 1, distance_oracle(a, b_rest) + 1,
                   distance_oracle(a_rest, b_rest) + (a[0] == b[0] ? 0 : 1)});
}

std::string random_word(std::mt19937& random) {
  std::string word(std::uniform_int_distribution<std::size_t>(0, 5)(random), ' ');
  for (char& letter : word) letter = "abc"[random() % 3];
  return word;
}

}  // namespace

TEST(Spelling, NearestHasTheFewestEdits) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const std::string name = random_word(random);
    const std::vector<std::string> legal{random_word(random), random_word(random),
                                         random_word(random)};
    std::size_t least = 100;
    for (const std::string& word : legal) least = std::min(least, distance_oracle(name, word));
    EXPECT_EQ(distance_oracle(name, nearest_name(name, legal)), least) << name;
  }
}

TEST(Spelling, ParametersAsPeopleMistypeThem) {
  const std::vector<std::string> legal{"rate", "tools", "picker", "tf_timeout_sec",
                                       "mesh_timeout_sec"};
  EXPECT_EQ(nearest_name("rates", legal), "rate");
  EXPECT_EQ(nearest_name("mesh_timeout", legal), "mesh_timeout_sec");
  EXPECT_EQ(nearest_name("pciker", legal), "picker");
}

TEST(Spelling, FirstOfSeveral) { EXPECT_EQ(nearest_name("b", {"a", "c"}), "a"); }

TEST(Spelling, Listed) {
  EXPECT_EQ(listed({}), "");
  EXPECT_EQ(listed({"a"}), "a");
  EXPECT_EQ(listed({"a", "b", "c"}), "a, b, c");
}
