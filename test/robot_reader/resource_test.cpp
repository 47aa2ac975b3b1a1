#include "robot_reader/resource.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "ros/tools/reader_limits.hpp"
#include "test/ros/tools/tool_files.hpp"

using namespace organ_collision;

namespace {

std::string refusal(const std::string& name) {
  return tool_error([&] { read_resource(name); });
}

}  // namespace

TEST(Resource, ReadsPathsAndUrls) {
  const std::string path = ORGAN_COLLISION_TEST_DATA "/tools/notes.txt";
  EXPECT_EQ(read_resource(path), "This is no mesh.\n");
  EXPECT_EQ(read_resource("file://" + path), "This is no mesh.\n");
  EXPECT_EQ(read_resource(tool_file("notes.txt")), "This is no mesh.\n");
}

TEST(Resource, ReadsBytesAsTheyAre) {
  const std::string path = testing::TempDir() + "bytes with a blank in their name";
  const std::string bytes("\0\r\n\xff\x1a!", 6);
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_EQ(read_resource(path), bytes);
  std::remove(path.c_str());
}

TEST(Resource, RefusalsNameTheFileAndWhy) {
  expect_words(refusal("/no/such.stl"), {"'/no/such.stl'", "no such file"});
  expect_words(refusal("file:///no/such.stl"), {"'/no/such.stl'", "no such file"});
  expect_words(refusal("/etc/passwd/such.stl"), {"Not a directory"});
  expect_words(refusal(tool_file("such.stl")), {"/test/data/tools/such.stl", "no such file"});
  expect_words(refusal("package://no_such_package/jaw.stl"), {"no_such_package", "not exist"});
  expect_words(refusal("package://organ_collision"), {"no file in the package"});
  expect_words(refusal("file://server/jaw.stl"), {"'file://server/jaw.stl'", "absolute path"});
  expect_words(refusal("meshes/jaw.stl"), {"'meshes/jaw.stl'", "absolute path", "package://"});
  expect_words(refusal(""), {"''", "absolute path", "package://"});
}

TEST(Resource, ServersAreNotAsked) {
  // These addresses would never answer.
  for (const std::string url : {"http://192.0.2.1/jaw.stl", "https://192.0.2.1/jaw.stl",
                                "HTTP://192.0.2.1/jaw.stl", "ftp://192.0.2.1/jaw.stl"}) {
    expect_words(refusal(url), {"'" + url + "'", "absolute path", "package:// or file://"});
  }
}

TEST(Resource, EscapesInUrlsAreBytes) {
  const std::string path = testing::TempDir() + "a 100% b%00.stl";
  std::ofstream(path) << "mesh";
  EXPECT_EQ(read_resource(path), "mesh");
  EXPECT_EQ(read_resource("file://" + testing::TempDir() + "a%20100% %62%00.stl"), "mesh");
  std::remove(path.c_str());
}

TEST(Resource, WhatIsNoRegularFileIsRefused) {
  expect_words(refusal("/tmp"), {"'/tmp'", "folder"});
  expect_words(refusal("file:///tmp"), {"'/tmp'", "folder"});
  expect_words(refusal("/dev/zero"), {"'/dev/zero'", "device", "regular file"});

  const std::string path = testing::TempDir() + "file.stl", link = testing::TempDir() + "link.stl";
  ASSERT_EQ(symlink(path.c_str(), link.c_str()), 0);
  const auto expect_refused = [&](const std::vector<std::string>& words) {
    expect_words(refusal(path), words);
    expect_words(refusal(link), words);
    std::remove(path.c_str());
  };
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);  // Opening it would block forever.
  expect_refused({"FIFO", "regular file"});

  std::ofstream(path).flush();
  expect_refused({"empty"});

  std::ofstream(path).flush();
  ASSERT_EQ(truncate(path.c_str(), reader_limits::kFileBytes + 1), 0);
  expect_refused({"100000001 bytes", "at most 100000000"});

  ASSERT_EQ(symlink(link.c_str(), path.c_str()), 0);
  expect_refused({"symbolic links"});
  std::remove(link.c_str());
}
