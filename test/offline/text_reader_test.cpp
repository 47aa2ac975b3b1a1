#include "offline/text_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "temporary_file.hpp"

namespace organ_collision {
namespace {

std::vector<std::string> lines_of(const std::string& content) {
  const TemporaryFile file(content);
  TextReader text(file.path());
  std::vector<std::string> lines;
  while (text.next()) {
    lines.emplace_back(text.line());
    EXPECT_EQ(text.number(), lines.size());
  }
  EXPECT_EQ(text.number(), std::max<std::size_t>(lines.size(), 1));
  return lines;
}

TEST(TextReader, takes_unix_and_windows_lines) {
  const std::vector<std::string> expected{"a b", "", "c"};
  EXPECT_EQ(lines_of("a b\n\nc\n"), expected);
  EXPECT_EQ(lines_of("a b\n\nc"), expected);
  EXPECT_EQ(lines_of("a b\r\n\r\nc\r\n"), expected);
  EXPECT_EQ(lines_of("  a b \t\n   \n\tc  \r\n"), expected);
  EXPECT_EQ(lines_of("\xEF\xBB\xBF"
                     "a b\n\nc\n"),
            expected);
}

TEST(TextReader, takes_an_empty_file) { EXPECT_TRUE(lines_of("").empty()); }

TEST(TextReader, refuses_what_is_no_file) {
  EXPECT_EQ(input_error([] { TextReader("/nowhere/a.csv"); }),
            "/nowhere/a.csv: cannot be opened: No such file or directory");
  EXPECT_EQ(input_error([] { TextReader("/").next(); }), "/: cannot be read: Is a directory");
  EXPECT_EQ(input_error([] { TextReader("/").is_ready(); }), "/: cannot be read: Is a directory");
}

TEST(TextReader, names_the_present_line_in_errors) {
  const TemporaryFile file("a\nb\nc\n");
  TextReader text(file.path());
  text.next();
  text.next();
  EXPECT_STREQ(text.error("no").what(), (file.path() + ":2: no").c_str());
}

using Texts = std::vector<std::string_view>;

Texts words(std::string_view line) {
  Texts words{"an earlier one"};
  split_words(line, words);
  return words;
}

Texts cells(std::string_view line) {
  Texts cells{"an earlier one"};
  split_cells(line, cells);
  return cells;
}

TEST(TextReader, knows_its_name) {
  EXPECT_EQ(TextReader("/dev/null").name(), "/dev/null");
  EXPECT_EQ(TextReader(StandardInput{}).name(), "standard input");
}

TEST(TextReader, is_ready_for_each_line_of_a_file_and_for_its_end) {
  const TemporaryFile file("a\nb");
  TextReader text(file.path());
  for (const char* line : {"a", "b"}) {
    EXPECT_TRUE(text.is_ready());
    ASSERT_TRUE(text.next());
    EXPECT_EQ(text.line(), line);
  }
  EXPECT_TRUE(text.is_ready());
  EXPECT_FALSE(text.next());
}

TEST(TextReader, splits_words_and_cells) {
  EXPECT_EQ(words("f 1 \t22  3"), (Texts{"f", "1", "22", "3"}));
  EXPECT_EQ(words(" f "), (Texts{"f"}));
  EXPECT_TRUE(words("").empty());
  EXPECT_TRUE(words(" \t").empty());
  EXPECT_EQ(cells("a, b ,,c"), (Texts{"a", "b", "", "c"}));
  EXPECT_EQ(cells("a,"), (Texts{"a", ""}));
  EXPECT_EQ(cells(""), (Texts{""}));
}

TEST(TextReader, parses_whole_numbers_only_from_end_to_end) {
  EXPECT_EQ(parse_number("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(parse_number("0.1"), 0.1);
  EXPECT_EQ(parse_number(std::string_view("12,5").substr(0, 2)), 12.0);
  EXPECT_EQ(parse_number("+2"), 2.0);
  EXPECT_EQ(parse_number("0x10"), 16.0);
  EXPECT_EQ(parse_number("4.9e-324"), 4.9e-324);
  EXPECT_EQ(parse_number("1e-999"), 0.0);
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

}  // namespace
}  // namespace organ_collision
