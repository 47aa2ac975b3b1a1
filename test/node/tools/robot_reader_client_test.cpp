#include "node/tools/robot_reader_client.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tool_files.hpp"

using namespace organ_collision;
using std::chrono::milliseconds;

namespace {

ProcessResult run_shell(const std::string& script, const std::string& input = "",
                        milliseconds limit = kReadingTime) {
  return run_process({"/bin/sh", "-c", script}, input, limit);
}

std::string robot_of(const std::string& mesh) {
  return "<robot name='probe'><link name='tip'><collision><geometry><mesh filename='" + mesh +
         "'/></geometry></collision></link></robot>";
}

std::string refusal(const std::string& urdf, const std::vector<std::string>& links = {"tip"}) {
  return tool_error([&] { read_robot("-", urdf, links); });
}

}  // namespace

TEST(ChildProcess, GivesInputAndArgumentsAndReturnsOutput) {
  std::string input(300'000, '\0');
  for (std::size_t i = 0; i < input.size(); ++i) input[i] = static_cast<char>(i % 251);
  const std::string script = "printf '%s|' \"$@\"; tee /dev/stderr; printf '\\nlast\\n' >&2";
  const ProcessResult result =
      run_process({"/bin/sh", "-c", script, "sh", "a b", "", "--c"}, input);
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.output, "a b||--c|" + input);
  EXPECT_EQ(result.last_line, "last");
}

TEST(ChildProcess, SaysHowTheProgramEnded) {
  struct Row {
    std::string script, failure;
  };
  for (const Row& row : {Row{"exit 0", ""}, Row{"echo partly; exit 3", "ended with exit code 3"},
                         Row{"kill -SEGV $$", "was ended by signal 11 (Segmentation fault)"},
                         Row{"exec sleep 100", "took more than 300 ms"},
                         Row{"sleep 100 & exit 3", "took more than 300 ms"}}) {
    const std::string unread(10'000'000, 'x');
    EXPECT_EQ(run_shell(row.script, unread, milliseconds(300)).failure, row.failure) << row.script;
  }
  EXPECT_EQ(run_shell("exec cat /dev/zero").failure, "wrote too much");
  EXPECT_EQ(run_shell("echo partly; exit 3").output, "partly\n");
}

TEST(RobotReader, ReadsFilesAndTexts) {
  const std::vector<std::string> names = {"jaw", "shaft"};
  for (const auto& links : {read_robot(tool_file("gripper.urdf"), "", names),
                            read_robot("-", tool_text("gripper.urdf"), names)}) {
    ASSERT_EQ(links.size(), 2u);
    EXPECT_EQ(links[0].joint, "jaw_joint");
    EXPECT_EQ(links[0].shapes.at(0).triangles.size(), 12u);
    EXPECT_EQ(links[1].joint, "insertion");
    EXPECT_EQ(links[1].shapes.size(), 2u);
    // A reply is taken whole or not at all.
    const std::string bytes = reply_of(links);
    EXPECT_EQ(parse_reply(bytes), links);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(parse_reply(bytes.substr(0, size))) << size;
    }
    EXPECT_FALSE(parse_reply(bytes + '\0') || parse_reply(bytes + bytes));
    std::vector<RobotLink> odd = links;
    odd[0].shapes[0].vertices.pop_back();
    EXPECT_FALSE(parse_reply(reply_of(odd)));
    odd[0].shapes[0] = {};
    odd[0].shapes[0].kind = RobotShape::MESH + 1;
    EXPECT_FALSE(parse_reply(reply_of(odd)));
  }
}

TEST(RobotReader, RefusalsAreTheReaders) {
  for (const std::string name : {"", "-", "--help", "a b", "\xff", "a\nb"}) {
    expect_words(refusal(tool_text("gripper.urdf"), {name}),
                 {"link '", "' is unknown; nearest is"});
  }
  expect_words(refusal(""), {"no legal URDF"});
  expect_words(tool_error([] { read_robot("/no/such.urdf", "", {"tip"}); }), {"no such file"});
}

// Some versions of the parsers crash on these files; others report the error. The parser of URDF
// needs a time that grows with the square of the depth.
TEST(RobotReader, FilesAtWhichTheReaderCrashesOrHangsAreRefusedByName) {
  expect_words(refusal(robot_of(tool_file("crashing.dae"))), {"link 'tip': mesh", "crashing.dae"});
#ifndef __SANITIZE_THREAD__  // Its printf does not crash, so the file is read.
  EXPECT_FALSE(refusal(tool_text("crashing.urdf")).empty());
#endif
  std::string urdf = "<robot name='probe'><link name='tip'/>";
  for (int i = 0; i < 60'000; ++i) urdf += "<a>";
  for (int i = 0; i < 60'000; ++i) urdf += "</a>";
  expect_words(tool_error([&] { read_robot("-", urdf + "</robot>", {"tip"}, milliseconds(200)); }),
               {"robot_reader took more than 200 ms while it read it", "too large"});
}
