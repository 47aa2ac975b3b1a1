#include "offline/text_reader.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <future>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "temporary_files.hpp"

namespace organ_collision {
namespace {

TEST(InputError, names_file_and_line) {
  EXPECT_STREQ(InputError("liver.obj", 12, "x is abc").what(), "liver.obj:12: x is abc");
}

TEST(InputError, puts_in_quotes_what_can_stand_in_one_line) {
  EXPECT_EQ(in_quotes("a b"), "\"a b\"");
  EXPECT_EQ(in_quotes(""), "\"\"");
  EXPECT_EQ(in_quotes(std::string_view("a\nb\tc\0d\x7f", 8)), "\"a?b?c?d?\"");
  EXPECT_EQ(in_quotes(std::string(60, 'x')), '"' + std::string(60, 'x') + '"');
  EXPECT_EQ(in_quotes(std::string(61, 'x')), '"' + std::string(60, 'x') + "...\"");
}

/// A pipe. The test writes into one end, and the source reads from the other one.
class Pipe {
 public:
  Pipe() {
    if (pipe(ends_) != 0) throw std::system_error(errno, std::generic_category());
  }
  ~Pipe() {
    close_input();
    close(ends_[0]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int output() const { return ends_[0]; }
  void write(const std::string& text) {
    ASSERT_EQ(::write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void close_input() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  int ends_[2];
};

TEST(LineSource, is_ready_when_a_whole_line_has_arrived) {
  Pipe pipe;
  LineSource source(pipe.output());
  EXPECT_FALSE(source.is_ready());
  pipe.write("fir");
  EXPECT_FALSE(source.is_ready());
  pipe.write("st\nsecond\nthi");
  EXPECT_TRUE(source.is_ready());
  ASSERT_TRUE(source.next());
  EXPECT_EQ(source.line(), "first");
  EXPECT_TRUE(source.is_ready());
  ASSERT_TRUE(source.next());
  EXPECT_EQ(source.line(), "second");
  EXPECT_FALSE(source.is_ready());
  pipe.close_input();
  EXPECT_TRUE(source.is_ready());
  ASSERT_TRUE(source.next());
  EXPECT_EQ(source.line(), "thi");
  EXPECT_TRUE(source.is_ready());
  EXPECT_FALSE(source.next());
  EXPECT_FALSE(source.next());
}

TEST(LineSource, gives_empty_lines_and_no_line_after_the_last_line_feed) {
  Pipe pipe;
  pipe.write("\na\n\n");
  pipe.close_input();
  LineSource source(pipe.output());
  for (const char* line : {"", "a", ""}) {
    ASSERT_TRUE(source.next());
    EXPECT_EQ(source.line(), line);
  }
  EXPECT_FALSE(source.next());
}

TEST(LineSource, takes_lines_that_are_longer_than_what_it_reads_at_once) {
  char path[] = "/tmp/line_source_XXXXXX";
  const int file = mkstemp(path);
  ASSERT_GE(file, 0);
  unlink(path);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < 40; ++i) lines.emplace_back(1 + i * i * 200, char('a' + i % 26));
  for (const std::string& line : lines) {
    ASSERT_EQ(write(file, (line + '\n').data(), line.size() + 1), ssize_t(line.size() + 1));
  }
  lseek(file, 0, SEEK_SET);
  LineSource source(file);
  for (const std::string& line : lines) {
    EXPECT_TRUE(source.is_ready());
    ASSERT_TRUE(source.next());
    EXPECT_EQ(source.line(), line);
  }
  EXPECT_FALSE(source.next());
  close(file);
}

TEST(LineSource, waits_for_a_pipe_that_does_not_block) {
  Pipe pipe;
  ASSERT_EQ(fcntl(pipe.output(), F_SETFL, O_NONBLOCK), 0);
  LineSource source(pipe.output());
  EXPECT_FALSE(source.is_ready());
  auto line = std::async(std::launch::async,
                         [&] { return source.next() ? std::string(source.line()) : "nothing"; });
  EXPECT_EQ(line.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  pipe.write("late\n");
  EXPECT_EQ(line.get(), "late");
}

TEST(LineSource, tells_whether_the_last_line_has_a_line_feed) {
  for (const bool has_line_feed : {false, true}) {
    Pipe pipe;
    pipe.write(has_line_feed ? "first\nlast\n" : "first\nlast");
    pipe.close_input();
    LineSource source(pipe.output());
    ASSERT_TRUE(source.next());
    EXPECT_FALSE(source.ends_within_line());
    ASSERT_TRUE(source.next());
    EXPECT_FALSE(source.next());
    EXPECT_EQ(source.ends_within_line(), !has_line_feed);
  }
}

TEST(LineSource, throws_if_a_line_is_too_long) {
  char path[] = "/tmp/line_source_XXXXXX";
  const int file = mkstemp(path);
  ASSERT_GE(file, 0);
  unlink(path);
  const std::string longest(LineSource::kLongestLine, 'a');
  for (const std::string& text : {longest + "\n", longest + "b"}) {
    ASSERT_EQ(write(file, text.data(), text.size()), ssize_t(text.size()));
  }
  lseek(file, 0, SEEK_SET);
  LineSource source(file);
  ASSERT_TRUE(source.next());
  EXPECT_EQ(source.line(), longest);
  EXPECT_THROW(source.is_ready(), std::length_error);
  EXPECT_THROW(source.next(), std::length_error);
  close(file);
}

TEST(LineSource, throws_if_nothing_can_be_read) {
  LineSource source(-1);
  EXPECT_THROW(source.next(), std::system_error);
  const int folder = open("/", O_RDONLY);
  EXPECT_THROW(LineSource(folder).is_ready(), std::system_error);
  close(folder);
}

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
