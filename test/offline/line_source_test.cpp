#include "offline/line_source.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace organ_collision {
namespace {

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

}  // namespace
}  // namespace organ_collision
