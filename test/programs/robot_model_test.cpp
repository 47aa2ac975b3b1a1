#include "programs/robot_reader/robot_model.hpp"

#include <console_bridge/console.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "common/messages/robot_reply.hpp"
#include "test/node/tools/tool_files.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

/// The answer, as the node reads it.
RobotReply ask(const std::function<std::string()>& urdf, const std::vector<std::string>& links) {
  std::string bytes;
  answer_with_links(urdf, links, [&](const std::string& record) { bytes += record; });
  return parse_reply(bytes);
}

RobotLink link(const std::string& urdf, const std::string& name) {
  return ask([&] { return urdf; }, {name}).links.value().front();
}

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
std::string refusal(const std::string& urdf, const std::string& link = "tip") {
  const RobotReply reply = ask([&] { return urdf; }, {link});
  EXPECT_FALSE(reply.links);
  return reply.refusal.value();
}

class SilentHandler : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel, const char*, int) override {
    texts.push_back(text);
  }
  std::vector<std::string> texts;
};

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

TEST(RobotModel, VisualShapesWhereThereAreNoOthers) {
  const RobotLink wrist = link(gripper(), "wrist");
  ASSERT_EQ(wrist.shapes.size(), 1u);
  const RobotShape& box = wrist.shapes[0];
  EXPECT_EQ(box.kind, RobotShape::BOX);
  EXPECT_EQ(Vector3d(&box.size[0]), Vector3d(0.02, 0.04, 0.06));
  expect_pose(box, {0.5, 0.25, -0.125}, Vector3d::UnitY());
}

TEST(RobotModel, MovingJoints) {
  for (const auto& [name, joint] : {std::pair("mount", ""),
                                    {"shaft", "insertion"},
                                    {"wrist", ""},
                                    {"jaw", "jaw_joint"},
                                    {"other_jaw", "other_jaw_joint"}}) {
    EXPECT_EQ(link(gripper(), name).joint, joint);
  }
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

TEST(RobotModel, FaultsOfOtherLinksDoNotMatter) {
  const std::string urdf = robot(
      "<link name='tip'><collision><geometry><sphere radius='1'/></geometry></collision></link>"
      "<link name='tip_2'><collision><geometry><cone/></geometry></collision></link>"
      "<joint name='j' type='fixed'><parent link='tip'/><child link='tip_2'/></joint>");
  EXPECT_EQ(link(urdf, "tip").shapes.size(), 1u);
  expect_words(refusal(urdf, "tip_2"), {"'tip_2'", "cone"});
}

TEST(RobotModel, LogsNothingAndLeavesConsoleBridgeAsItWas) {
  SilentHandler handler;
  console_bridge::useOutputHandler(&handler);
  refusal(robot_of("<cone/>"));
  EXPECT_EQ(console_bridge::getOutputHandler(), &handler);
  refusal("");
  EXPECT_EQ(console_bridge::getOutputHandler(), &handler);
  EXPECT_TRUE(handler.texts.empty());
  console_bridge::noOutputHandler();
}

TEST(RobotAnswer, HasTheLinksInTheOrderOfTheirNames) {
  const RobotReply reply = ask(gripper, {"shaft", "jaw", "shaft"});
  EXPECT_FALSE(reply.refusal);
  EXPECT_EQ(reply.reading, "link 'jaw': mesh '" + tool_file("jaw_binary.stl") + "'");
  ASSERT_TRUE(reply.links);
  ASSERT_EQ(reply.links->size(), 3U);
  EXPECT_EQ((*reply.links)[0].shapes.size(), 2U);
  EXPECT_EQ((*reply.links)[2].shapes.size(), 2U);
  ASSERT_EQ((*reply.links)[1].shapes.size(), 1U);
  const RobotShape& mesh = (*reply.links)[1].shapes[0];
  EXPECT_EQ(mesh.kind, RobotShape::MESH);
  EXPECT_EQ(mesh.file, tool_file("jaw_binary.stl"));
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_EQ(mesh.vertices.size(), 12U);
}

TEST(RobotAnswer, ARelativeMeshBeginsAtTheFolderOfTheUrdf) {
  const std::string urdf = robot_of("<mesh filename='jaw.obj'/>");
  std::string bytes;
  answer_with_links([&] { return urdf; }, {"tip"}, [&](const auto& record) { bytes += record; },
                    tool_file(""));
  ASSERT_TRUE(parse_reply(bytes).links);
  expect_words(ask([&] { return urdf; }, {"tip"}).refusal.value_or("accepted"),
               {"'jaw.obj'", "must be an absolute path, or begin with package://"});
}

TEST(RobotAnswer, APointerOfGitLfsIsNamed) {
  const std::string urdf = robot_of("<mesh filename='" + tool_file("lfs_pointer.stl") + "'/>");
  expect_words(ask([&] { return urdf; }, {"tip"}).refusal.value_or("accepted"),
               {"lfs_pointer.stl", "only a pointer of Git LFS", "git lfs pull"});
}

TEST(RobotAnswer, NamesAMeshBeforeItIsRead) {
  std::vector<std::string> records;
  answer_with_links([] { return robot_of("<mesh filename='" + tool_file("jaw.obj") + "'/>"); },
                    {"tip"}, [&](const std::string& record) { records.push_back(record); });
  ASSERT_EQ(records.size(), 2U);
  const RobotReply cut_off = parse_reply(records[0]);
  expect_words(cut_off.reading, {"tip", "jaw.obj"});
  EXPECT_FALSE(cut_off.refusal || cut_off.links);
}

TEST(RobotAnswer, IsARefusalIfSomethingCannotBeRead) {
  const std::string no_file = robot_of("<mesh filename='package://organ_collision/no.stl'/>");
  const std::string flat =
      robot_of("<mesh filename='" + tool_file("jaw.obj") + "' scale='1 0 1'/>");
  const std::vector<std::pair<std::string, std::vector<std::string>>> rows = {
      {robot_of("<sphere radius='1'/>"), {"nobody"}},
      {no_file, {"'tip'", "no.stl"}},
      {flat, {"'tip'", "jaw.obj", "1 0 1"}},
      {robot_of("<mesh filename=''/>"), {"'tip'", "''"}}};
  for (const auto& [urdf, words] : rows) {
    const RobotReply reply = ask([&urdf = urdf] { return urdf; }, {"tip", "nobody"});
    ASSERT_TRUE(reply.refusal);
    expect_words(*reply.refusal, words);
    EXPECT_FALSE(reply.links);
  }
  const auto missing = []() -> std::string { throw ToolError("cannot read 'x.urdf'"); };
  EXPECT_EQ(ask(missing, {"tip"}).refusal, "cannot read 'x.urdf'");
}
