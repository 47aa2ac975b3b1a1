#include "organ_collision/ros/resource.hpp"

#include <gtest/gtest.h>
#include <ros/package.h>

#include <cstdio>
#include <fstream>

#include "tool_files.hpp"

using namespace organ_collision;

namespace {

std::string refusal(const std::string& name) {
  return tool_error([&] { read_resource(name); });
}

}  // namespace

TEST(Resource, ReadsPathsAndUrls) {
  const std::string path = ros::package::getPath("organ_collision") + "/test/data/tools/notes.txt";
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
  expect_words(refusal("file:///no/such.stl"), {"/no/such.stl", "open"});
  expect_words(refusal(tool_file("such.stl")), {"/test/data/tools/such.stl", "open"});
  expect_words(refusal("package://no_such_package/jaw.stl"), {"no_such_package", "not exist"});
  expect_words(refusal("meshes/jaw.stl"), {"'meshes/jaw.stl'", "absolute path", "package://"});
  expect_words(refusal(""), {"''", "absolute path", "package://"});
}

TEST(Resource, ServersAreNotAsked) {
  // As this one would never answer.
  for (const std::string url : {"http://192.0.2.1/jaw.stl", "https://192.0.2.1/jaw.stl",
                                "HTTP://192.0.2.1/jaw.stl", "ftp://192.0.2.1/jaw.stl"}) {
    expect_words(refusal(url), {"'" + url + "'", "absolute path", "package:// or file://"});
  }
}

TEST(Resource, FoldersAndEmptyFilesAreRefused) {
  expect_words(refusal("/tmp"), {"'/tmp'", "folder"});
  expect_words(refusal("file:///tmp"), {"'file:///tmp'", "folder"});
  const std::string path = testing::TempDir() + "empty.stl";
  std::ofstream(path).flush();
  expect_words(refusal(path), {path, "empty"});
  std::remove(path.c_str());
}
