#include "ros/interface/plain_text.hpp"

#include <gtest/gtest.h>

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
