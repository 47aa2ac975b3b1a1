#include "offline/text_reader.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <string>
#include <system_error>
#include <vector>

#include "temporary_files.hpp"

namespace organ_collision {
namespace {

using Lines = std::vector<std::string>;

Lines lines_of(const std::string& content) {
  const TemporaryFile file(content);
  TextReader text(file.path());
  Lines lines;
  while (text.is_ready() && text.next()) lines.emplace_back(text.line());
  return lines;
}

TEST(TextReader, takes_unix_and_windows_lines_without_blank_ones) {
  for (const char* content :
       {"a b\nc\n", "a b\n\nc", "a b\r\n\r\nc\r\n", "\n  a b \t\n   \n\tc  \r\n\n",
        "\xEF\xBB\xBF"
        "a b\nc\n",
        "\xEF\xBB\xBF\r\na b\nc\n"}) {
    EXPECT_EQ(lines_of(content), (Lines{"a b", "c"})) << content;
  }
  for (const char* content : {"", "\n", " \t\r\n\n "}) EXPECT_TRUE(lines_of(content).empty());
}

TEST(TextReader, takes_lines_that_are_longer_than_what_it_reads_at_once) {
  Lines lines;
  std::string content;
  for (std::size_t i = 0; i < 40; ++i) {
    lines.emplace_back(1 + i * i * 200, static_cast<char>('a' + i % 26));
    content += lines.back() + '\n';
  }
  EXPECT_EQ(lines_of(content), lines);
}

TEST(TextReader, counts_all_lines_for_errors) {
  const TemporaryFile file("\na\n\n\nb\n\n");
  TextReader text(file.path());
  ASSERT_TRUE(text.next());
  EXPECT_EQ(text.number(), 2U);
  ASSERT_TRUE(text.next());
  EXPECT_STREQ(text.error("no").what(), (file.path() + ":5: no").c_str());
  EXPECT_FALSE(text.next());
  EXPECT_EQ(text.number(), 6U);
  EXPECT_EQ(TextReader("/dev/null").number(), 1U);
}

TEST(TextReader, refuses_what_it_cannot_read) {
  EXPECT_EQ(input_error([] { TextReader("/nowhere/a.csv"); }),
            "/nowhere/a.csv: cannot be opened: No such file or directory");
  EXPECT_EQ(input_error([] { TextReader("/").next(); }), "/: cannot be read: Is a directory");
  EXPECT_EQ(input_error([] { TextReader("/").is_ready(); }), "/: cannot be read: Is a directory");
  const std::string longest(TextReader::kLongestLine, 'a');
  const TemporaryFile file(longest + "\n" + longest + "b");
  TextReader text(file.path());
  ASSERT_TRUE(text.next());
  EXPECT_EQ(text.line(), longest);
  EXPECT_EQ(input_error([&] { text.next(); }),
            file.path() +
                ":2: the line has more than 1048576 bytes; must be shorter, with a line feed at "
                "its end");
}

/// A pipe that takes the place of standard input.
class Pipe {
 public:
  Pipe() : former_(dup(STDIN_FILENO)) {
    if (pipe(ends_) != 0) throw std::system_error(errno, std::generic_category());
    dup2(ends_[0], STDIN_FILENO);
  }
  ~Pipe() {
    close_input();
    close(ends_[0]);
    dup2(former_, STDIN_FILENO);
    close(former_);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void write(const std::string& text) {
    ASSERT_EQ(::write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void close_input() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  int former_;
  int ends_[2];
};

TEST(TextReader, is_ready_when_a_whole_line_has_arrived) {
  for (const int flags : {0, O_NONBLOCK}) {
    Pipe pipe;
    ASSERT_EQ(fcntl(STDIN_FILENO, F_SETFL, flags), 0);
    TextReader text(StandardInput{});
    EXPECT_EQ(text.name(), "standard input");
    for (const char* part : {"", "fir", "st"}) {
      pipe.write(part);
      EXPECT_FALSE(text.is_ready());
    }
    pipe.write("\n\n \nsecond\nthi");
    for (const char* line : {"first", "second"}) {
      EXPECT_TRUE(text.is_ready());
      ASSERT_TRUE(text.next());
      EXPECT_EQ(text.line(), line);
      EXPECT_FALSE(text.ends_within_line());
    }
    EXPECT_FALSE(text.is_ready());
    auto next = std::async(std::launch::async, [&] { return text.next(); });
    EXPECT_EQ(next.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout);
    pipe.close_input();
    ASSERT_TRUE(next.get());
    EXPECT_EQ(text.line(), "thi");
    EXPECT_TRUE(text.ends_within_line());
    EXPECT_TRUE(text.is_ready());
    EXPECT_FALSE(text.next());
  }
}

}  // namespace
}  // namespace organ_collision
