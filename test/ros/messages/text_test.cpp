#include "ros/messages/text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace organ_collision;

namespace {

constexpr std::size_t kMost = 100;

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

}  // namespace

TEST(PlainText, PlainTextStaysAsItIs) {
  for (const std::string text : {"", "liver", "a b/c", "ø", "肝臓", "🫀", "\u00A0", "\uFFFD"}) {
    EXPECT_EQ(plain_text(text, kMost), text);
  }
}

TEST(PlainText, ControlCharactersBecomeSpaces) {
  EXPECT_EQ(plain_text("a\nb\tc\x1B[31md\x7F", kMost), "a b c [31md ");
  EXPECT_EQ(plain_text(std::string("a\0b", 3), kMost), "a b");
  EXPECT_EQ(plain_text("a\u0085b\u009Bc", kMost), "a b c");
}

TEST(PlainText, BytesThatAreNoUtf8BecomeQuestionMarks) {
  EXPECT_EQ(plain_text("a\xFF\xFE", kMost), "a??");
  EXPECT_EQ(plain_text("\x80", kMost), "?");
  EXPECT_EQ(plain_text("\xC3", kMost), "?");
  EXPECT_EQ(plain_text("\xC3(", kMost), "?(");
  EXPECT_EQ(plain_text("\xE8\x82", kMost), "??");
  EXPECT_EQ(plain_text("\xC0\xAF", kMost), "??") << "overlong";
  EXPECT_EQ(plain_text("\xE0\x80\xAF", kMost), "???") << "overlong";
  EXPECT_EQ(plain_text("\xF0\x80\x80\xAF", kMost), "????") << "overlong";
  EXPECT_EQ(plain_text("\xED\xA0\x80", kMost), "???") << "surrogate";
  EXPECT_EQ(plain_text("\xF4\x90\x80\x80", kMost), "????") << "beyond U+10FFFF";
}

TEST(PlainText, LongTextIsCutBetweenCharactersAndSaysHowMuch) {
  EXPECT_EQ(plain_text(std::string(kMost, 'x'), kMost), std::string(kMost, 'x'));
  EXPECT_EQ(plain_text(std::string(kMost + 1, 'x'), kMost),
            std::string(60, 'x') + "... (41 more bytes)");
  EXPECT_EQ(plain_text("y" + repeated("肝", 40), kMost),
            "y" + repeated("肝", 19) + "... (63 more bytes)");
  EXPECT_EQ(plain_text(std::string(10'000'000, '\n'), kMost),
            std::string(60, ' ') + "... (9999940 more bytes)");
}

TEST(PlainText, WhateverComesIsPlainAfterwards) {
  std::mt19937 random(18);
  std::uniform_int_distribution<int> byte(0, 255), size(0, 300);
  for (int i = 0; i < 5000; ++i) {
    std::string text(static_cast<std::size_t>(size(random)), ' ');
    for (char& c : text) c = static_cast<char>(byte(random));
    const std::string plain = plain_text(text, kMost);
    EXPECT_LE(plain.size(), kMost);
    EXPECT_EQ(plain_text(plain, kMost), plain);
  }
}

TEST(PlainText, Counted) {
  EXPECT_EQ(counted(0, "face"), "0 faces");
  EXPECT_EQ(counted(1, "face"), "1 face");
  EXPECT_EQ(counted(2208, "face"), "2208 faces");
}

TEST(PlainText, Listed) {
  EXPECT_EQ(listed({}), "");
  EXPECT_EQ(listed({"a"}), "a");
  EXPECT_EQ(listed({"a", "b", "c"}), "a, b, c");
}

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

using namespace organ_collision;

TEST(DurationText, HasThreeDigits) {
  EXPECT_EQ(duration_text(0.0), "0 ms");
  EXPECT_EQ(duration_text(0.0073), "7.3 ms");
  EXPECT_EQ(duration_text(0.020004), "20 ms");
  EXPECT_EQ(duration_text(0.25), "250 ms");
  EXPECT_EQ(duration_text(2.4123), "2.41 s");
}

TEST(DurationText, OfHoursHasAllDigitsBeforeThePoint) {
  EXPECT_EQ(duration_text(123456.7), "123457 s");
}
