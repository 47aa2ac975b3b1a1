#include "programs/robot_reader/robot_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "common/messages/robot_reply.hpp"
#include "test/node/tools/tool_files.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

std::vector<RobotLink> links(const std::string& urdf, const std::vector<std::string>& names,
                             const std::string& folder = {}) {
  return read_links(urdf, names, folder, [](const std::string&) {});
}

RobotLink link(const std::string& urdf, const std::string& name) { return links(urdf, {name})[0]; }

const std::string& gripper() {
  static const std::string urdf = tool_text("gripper.urdf");
  return urdf;
}

void expect_pose(const RobotShape& shape, const Vector3d& position, const Vector3d& image_of_x) {
  const Eigen::Quaterniond orientation(&shape.pose[3]);
  EXPECT_LT((Vector3d(&shape.pose[0]) - position).norm(), 1e-15);
  EXPECT_LT((orientation * Vector3d::UnitX() - image_of_x).norm(), 1e-15);
}

std::string robot(const std::string& elements) {
  return "<robot name='probe'>" + elements + "</robot>";
}

/// The URDF of a robot with one link, 'tip', and its collision shape.
std::string robot_of(const std::string& shape) {
  return robot("<link name='tip'><collision><geometry>" + shape + "</geometry></collision></link>");
}

/// For a robot whose link cannot be read.
std::string refusal(const std::string& urdf, const std::string& name = "tip") {
  return tool_error([&] { link(urdf, name); });
}

}  // namespace

TEST(RobotModel, CollisionShapesWhereTheirOriginsAre) {
  const RobotLink shaft = link(gripper(), "shaft");
  ASSERT_EQ(shaft.shapes.size(), 2u);  // Without the visual box.
  const RobotShape& cylinder = shaft.shapes[0];
  EXPECT_EQ(cylinder.kind, RobotShape::CYLINDER);
  EXPECT_EQ(Vector3d(&cylinder.size[0]), Vector3d(0.004, 0.3, 0.0));
  expect_pose(cylinder, {0.01, -0.02, 0.1}, -Vector3d::UnitZ());
  const RobotShape& sphere = shaft.shapes[1];
  EXPECT_EQ(sphere.kind, RobotShape::SPHERE);
  EXPECT_EQ(sphere.size[0], 0.005);
  expect_pose(sphere, {0.16, -0.02, 0.1}, Vector3d::UnitX());
}

TEST(RobotModel, WhatIsNoUrdfIsRefusedWithTheReason) {
  // Where the file is no XML, the reason is in the words of urdfdom's parser, which versions
  // change.
  for (const std::string no_xml : {"", "<robot name='probe'><link name='tip'></robot>"}) {
    expect_words(refusal(no_xml), {"no legal URDF: "});
    EXPECT_GT(refusal(no_xml).size(), std::string("no legal URDF: ").size());
  }
  expect_words(refusal("<sdf/>"), {"'robot'"});
  expect_words(refusal(robot("<link name='a'/><link name='b'/>")), {"root", "[a]", "[b]"});
  expect_words(refusal(robot("<link name='a'/><link name='a'/>")), {"'a'", "not unique"});
}

TEST(RobotModel, UnknownLinksAreNamedWithTheNearest) {
  expect_words(refusal(gripper(), "jaws"),
               {"'jaws' is unknown", "nearest is 'jaw'", "jaw, mount, other_jaw, shaft, wrist"});
}

TEST(RobotModel, LinksReadInPartAreRefused) {
  // urdfdom would skip the second shape and all that follow.
  const std::string first = "<link name='tip'><collision><geometry><sphere radius='1'/>";
  const std::string second = "</geometry></collision><collision><geometry>";
  const std::string end = "</geometry></collision></link>";
  for (const std::string shape :
       {"<sphere radius='nan'/>", "<cone/>", "<sphere/>", "<mesh filename='a' scale='1 1'/>"}) {
    expect_words(refusal(robot(first + second + shape + end)), {"'tip'", "Link [tip]"});
  }
  expect_words(refusal(robot_of("<sphere radius='nan'/>")), {"radius [nan]"});
  expect_words(refusal(robot_of("<box size='1 1'/>")), {"[1 1]"});
}

TEST(RobotModel, MeshesThatCannotBeRead) {
  const auto of_mesh = [](const std::string& file, const std::string& scale = "1 1 1") {
    return robot_of("<mesh filename='" + file + "' scale='" + scale + "'/>");
  };
  EXPECT_EQ(links(of_mesh("jaw.obj"), {"tip"}, tool_file("")).size(), 1U);
  const std::pair<std::string, std::vector<std::string>> rows[] = {
      {of_mesh("jaw.obj"), {"'jaw.obj'", "must be an absolute path, or begin with package://"}},
      {of_mesh(tool_file("lfs_pointer.stl")), {"only a pointer of Git LFS", "git lfs pull"}},
      {of_mesh("package://organ_collision/no.stl"), {"'tip'", "no.stl"}},
      {of_mesh(tool_file("jaw.obj"), "1 0 1"), {"'tip'", "jaw.obj", "1 0 1"}},
      {of_mesh(""), {"'tip'", "''"}}};
  for (const auto& [urdf, words] : rows) expect_words(refusal(urdf), words);
}
