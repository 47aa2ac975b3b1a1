#include "ros/interface/legal_name.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "ros/interface/plain_text.hpp"

using namespace organ_collision;

namespace {

/// The recursive definition of the Levenshtein distance.
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

TEST(LegalName, NearestHasTheFewestEdits) {
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

TEST(LegalName, ParametersAsPeopleMistypeThem) {
  const std::vector<std::string> legal{"rate", "tools", "picker", "tf_timeout_sec",
                                       "mesh_timeout_sec"};
  EXPECT_EQ(nearest_name("rates", legal), "rate");
  EXPECT_EQ(nearest_name("mesh_timeout", legal), "mesh_timeout_sec");
  EXPECT_EQ(nearest_name("pciker", legal), "picker");
}

TEST(LegalName, FirstOfSeveral) { EXPECT_EQ(nearest_name("b", {"a", "c"}), "a"); }

TEST(LegalName, PlainTextIsLegal) {
  for (const std::string name : {"", "liver", "a b/c", "肝臓"}) EXPECT_EQ(name_fault(name), "");
}

TEST(LegalName, AFaultSaysWhatIsWrongAndWhatIsLegal) {
  EXPECT_EQ(name_fault(std::string(kLongestName, 'x')), "");
  const std::string too_long = name_fault(std::string(kLongestName + 1, 'x'));
  EXPECT_NE(too_long.find("has 257 bytes; a name must be"), std::string::npos) << too_long;
  EXPECT_LT(too_long.size(), 2 * kLongestName);
  EXPECT_EQ(name_fault("a\nb"),
            "'a b' has control characters, or bytes that are no UTF-8; a name must be UTF-8 "
            "without control characters, of at most 256 bytes");
  EXPECT_NE(name_fault("\xFF"), "");
}
