#include "ros/tools/robot_reader_client.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <fstream>

#include "ros/tools/link_description.hpp"
#include "tool_files.hpp"

using namespace organ_collision;

namespace {

std::string robot_of(const std::string& mesh) {
  return "<robot name='probe'><link name='tip'><collision><geometry><mesh filename='" + mesh +
         "'/></geometry></collision></link></robot>";
}

std::string refusal(const std::string& urdf, const std::vector<std::string>& links = {"tip"}) {
  return tool_error([&] { read_robot_text(urdf, links); });
}

}  // namespace

TEST(RobotReader, ReadsFilesAndTexts) {
  const std::vector<std::string> names = {"jaw", "shaft"};
  for (const auto& links : {read_robot_file(tool_file("gripper.urdf"), names),
                            read_robot_text(tool_text("gripper.urdf"), names)}) {
    ASSERT_EQ(links.size(), 2u);
    EXPECT_EQ(links[0].joint, "jaw_joint");
    EXPECT_EQ(std::get<MeshDescription>(links[0].shapes.at(0)).triangles.size(), 4u);
    EXPECT_EQ(links[1].joint, "insertion");
    EXPECT_EQ(links[1].shapes.size(), 2u);
  }
}

TEST(RobotReader, NamesOfLinksMayBeAnything) {
  for (const std::string name : {"", "-", "--help", "a b", "\xff"}) {
    expect_words(refusal(tool_text("gripper.urdf"), {name}), {"link '" + name + "' is unknown"});
  }
}

TEST(RobotReader, RefusalsAreTheReaders) {
  expect_words(refusal(""), {"no legal URDF"});
  expect_words(refusal(robot_of("/no/such.stl")), {"link 'tip'", "/no/such.stl", "no such file"});
  expect_words(tool_error([] { read_robot_file("/no/such.urdf", {"tip"}); }), {"no such file"});
  expect_words(tool_error([] { read_robot_file("-", {"tip"}); }), {"no legal URDF"});
}

// Some versions of the parsers crash on these files; others report the error.
TEST(RobotReader, FilesThatMayCrashTheReaderAreRefusedByName) {
  for (const std::string name : {"crashing.obj", "crashing.dae"}) {
    expect_words(refusal(robot_of(tool_file(name))),
                 {"link 'tip': mesh '" + tool_file(name) + "'"});
  }
#ifndef __SANITIZE_THREAD__  // Its printf does not crash, so the file is read.
  EXPECT_FALSE(refusal(tool_text("crashing.urdf")).empty());
#endif
}

TEST(RobotReader, TooMuchMemoryNamesTheFile) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer reserves more memory than the reader may have";
#endif
  expect_words(refusal(robot_of(tool_file("huge.ply"))),
               {"link 'tip': mesh '" + tool_file("huge.ply") + "'", "not enough memory"});
}

// A face claims to have 300 000 corners, and a comment makes the file large enough for them. The
// parser would need more than 10 s.
TEST(RobotReader, FilesThatTakeTooLongForTheirSizeAreRefusedByName) {
  const std::string path = testing::TempDir() + "long_face.ply";
  std::string text = tool_text("long_face.ply");
  text.insert(text.find("element vertex"), "comment " + std::string(300'000, '-') + "\n");
  std::ofstream(path) << text;
  expect_words(refusal(robot_of(path)), {"link 'tip': mesh '" + path + "'",
                                         "was ended by signal " + std::to_string(SIGPROF)});
  std::remove(path.c_str());
}

// This process sets itself a lower limit of processor time, which the reader inherits: it would
// read for ten seconds and more.
TEST(RobotReader, ManyFilesThatTakeTooLongAreRefusedByName) {
  const std::string path = testing::TempDir() + "slow.obj";
  {
    std::ofstream file(path);
    for (int i = 0; i < 150'000; ++i) file << "v 0.125 0.25 0.5\n";
    file << "f 1 2 3\n";
  }
  const auto former_action = std::signal(SIGXCPU, SIG_IGN);
  rlimit former{};
  getrlimit(RLIMIT_CPU, &former);
  const rlimit lower{1, former.rlim_max};
  setrlimit(RLIMIT_CPU, &lower);
  expect_words(refusal(robot_of(path), std::vector<std::string>(1000, "tip")),
               {"link 'tip': mesh '" + path + "'", "was ended by signal"});
  setrlimit(RLIMIT_CPU, &former);
  std::signal(SIGXCPU, former_action);
  std::remove(path.c_str());
}
