// The texts that programs read, and how programs tell their progress. command_lines_test.py
// tests the command lines of all programs.
#include "common/program/user_input.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace organ_collision {
namespace {

using Texts = std::vector<std::string_view>;

TEST(UserInput, is_named_in_refusals_of_one_line) {
  EXPECT_STREQ(InputError("liver.obj", 12, "x is abc").what(), "liver.obj:12: x is abc");
  EXPECT_EQ(in_quotes("a b"), "\"a b\"");
  EXPECT_EQ(in_quotes(std::string_view("a\nb\tc\0d\x7f", 8)), "\"a?b?c?d?\"");
  EXPECT_EQ(in_quotes(std::string(60, 'x')), '"' + std::string(60, 'x') + '"');
  EXPECT_EQ(in_quotes(std::string(61, 'x')), '"' + std::string(60, 'x') + "...\"");
}

TEST(UserInput, is_split_into_words_and_cells) {
  const auto words = [](std::string_view line) {
    Texts words{"an earlier one"};
    split_words(line, words);
    return words;
  };
  const auto cells = [](std::string_view line) {
    Texts cells{"an earlier one"};
    split_cells(line, cells);
    return cells;
  };
  EXPECT_EQ(words("f 1 \t22  3"), (Texts{"f", "1", "22", "3"}));
  EXPECT_EQ(words(" f "), (Texts{"f"}));
  EXPECT_EQ(words(" \t"), Texts{});
  EXPECT_EQ(cells("a, b ,,c"), (Texts{"a", "b", "", "c"}));
  EXPECT_EQ(cells("a,"), (Texts{"a", ""}));
  EXPECT_EQ(cells(""), (Texts{""}));
}

TEST(UserInput, is_a_number_only_from_end_to_end) {
  const std::pair<const char*, double> numbers[] = {
      {"-1.5e-3", -1.5e-3}, {"0.1", 0.1},           {"+2", 2.0},
      {"0x10", 16.0},       {"4.9e-324", 4.9e-324}, {"1e-999", 0.0}};
  for (const auto& [text, number] : numbers) EXPECT_EQ(parse_number(text), number) << text;
  EXPECT_EQ(parse_number(std::string_view("12,5").substr(0, 2)), 12.0);
  EXPECT_TRUE(std::isnan(parse_number("nan").value()));
  EXPECT_TRUE(std::isinf(parse_number("1e999").value()));
  for (const char* text : {"", "x", "1x", "1 2", "0.1.2", "1,5", "--1"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
  EXPECT_EQ(parse_integer("-12"), -12);
  for (const char* text : {"", "x", "1.0", "1e3", "99999999999999999999", "+1"}) {
    EXPECT_FALSE(parse_integer(text)) << text;
  }
}

TEST(Progress, is_told_with_the_total_if_that_is_known) {
  Progress known("prog", "motions", 7), unknown("prog", "lines", std::nullopt);
  testing::internal::CaptureStderr();
  known.report(1);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  known.report(3);
  unknown.report(4);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "prog: 3 of 7 motions\nprog: 4 lines\n");
}

}  // namespace
}  // namespace organ_collision
