#include "node/tools/robot_reader_client.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <system_error>

#include "common/messages/robot_reply.hpp"
#include "tool_files.hpp"

using namespace organ_collision;

namespace {

ProcessResult run_shell(const std::string& script, const std::string& input = "") {
  return run_process({"/bin/sh", "-c", script}, input);
}

/// Replaces a signal handler and restores it at its end.
class ScopedSignalAction {
 public:
  ScopedSignalAction(int signal, void (*action)(int))
      : signal_(signal), former_(std::signal(signal, action)) {}
  ~ScopedSignalAction() { std::signal(signal_, former_); }
  ScopedSignalAction(const ScopedSignalAction&) = delete;
  ScopedSignalAction& operator=(const ScopedSignalAction&) = delete;

 private:
  int signal_;
  void (*former_)(int);
};

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
  const ProcessResult result =
      run_process({"/bin/sh", "-c", "printf '%s|' \"$@\"; cat", "sh", "a b", "", "--c"}, input);
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.output, "a b||--c|" + input);
}

TEST(ChildProcess, SaysHowTheProgramEnded) {
  struct Row {
    std::string script, failure;
  };
  for (const Row& row :
       {Row{"exit 0", ""}, Row{"echo partly; exit 3", "ended with exit code 3"},
        Row{"kill -SEGV $$", "was ended by signal 11 (Segmentation fault)"},
        Row{"ulimit -f 100; exec yes", "was ended by signal 25 (File size limit exceeded)"}}) {
    const std::string unread(10'000'000, 'x');
    EXPECT_EQ(run_shell(row.script, unread).failure, row.failure) << row.script;
  }
  EXPECT_EQ(run_shell("echo partly; exit 3").output, "partly\n");
}

TEST(ChildProcess, WhatCannotBeStartedThrows) {
  EXPECT_THROW(run_process({"/no/such/program"}, ""), std::system_error);
  EXPECT_THROW(run_process({"/tmp"}, ""), std::system_error);
  EXPECT_THROW(run_process({"/bin/true", std::string(10'000'000, 'x')}, ""), std::system_error);
}

// Nodelet managers and simulators may ignore SIGCHLD or wait for all children.
TEST(ChildProcess, SignalsOfTheHostProcessDoNotMatter) {
  const ScopedSignalAction no_pipe(SIGPIPE, SIG_IGN), no_cpu(SIGXCPU, SIG_IGN);
  sigset_t all, former;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &former);
  EXPECT_EQ(run_shell("kill -TERM $$; echo alive").failure, "was ended by signal 15 (Terminated)");
  EXPECT_EQ(run_shell("kill -PIPE $$; echo alive").failure, "was ended by signal 13 (Broken pipe)");
  pthread_sigmask(SIG_SETMASK, &former, nullptr);
  const ScopedSignalAction no_child(SIGCHLD, SIG_IGN);
  EXPECT_EQ(run_shell("echo answer").output, "answer\n");
  EXPECT_EQ(run_shell("echo answer").failure, "");
}

TEST(ChildProcess, NothingIsLeftOpenOrWaitedFor) {
  const auto highest = [] {
    const int next = dup(0);
    close(next);
    return next;
  };
  const int before = highest();
  for (int i = 0; i < 20; ++i) {
    run_shell("echo a");
    EXPECT_THROW(run_process({"/no/such/program"}, ""), std::system_error);
  }
  EXPECT_EQ(highest(), before);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
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
  }
}

TEST(RobotReader, RefusalsAreTheReaders) {
  for (const std::string name : {"", "-", "--help", "a b", "\xff"}) {
    expect_words(refusal(tool_text("gripper.urdf"), {name}), {"link '" + name + "' is unknown"});
  }
  expect_words(refusal(""), {"no legal URDF"});
  expect_words(refusal(robot_of("/no/such.stl")), {"link 'tip'", "/no/such.stl", "no such file"});
  expect_words(tool_error([] { read_robot("/no/such.urdf", "", {"tip"}); }), {"no such file"});
}

// Some versions of the parsers crash on these files; others report the error.
TEST(RobotReader, FilesThatMayCrashTheReaderAreRefusedByName) {
  expect_words(refusal(robot_of(tool_file("crashing.dae"))), {"link 'tip': mesh", "crashing.dae"});
#ifndef __SANITIZE_THREAD__  // Its printf does not crash, so the file is read.
  EXPECT_FALSE(refusal(tool_text("crashing.urdf")).empty());
#endif
}

// The parser needs a time that grows with the square of the depth.
TEST(RobotReader, NestedElementsMayTakeNoLongerThanOtherFilesOfTheirSize) {
  constexpr int kDepth = 60'000;
  std::string urdf = "<robot name='probe'><link name='tip'/>";
  for (int i = 0; i < kDepth; ++i) urdf += "<a>";
  for (int i = 0; i < kDepth; ++i) urdf += "</a>";
  expect_words(refusal(urdf + "</robot>"),
               {"was ended by signal " + std::to_string(SIGPROF), "too large"});
}
