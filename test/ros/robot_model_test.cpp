#include "organ_collision/ros/robot_model.hpp"

#include <console_bridge/console.h>
#include <gtest/gtest.h>

#include "organ_collision/ros/resource.hpp"
#include "tool_files.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

RobotModel gripper() { return RobotModel(read_resource(tool_file("gripper.urdf"))); }

/// How far a part reaches along an axis, with its radius.
double reach(const LinkPart& part, const Vector3d& direction) {
  return part.height(direction) + part.radius;
}

/// The box around a part, along the link's axes.
void expect_extent(const LinkPart& part, const Vector3d& lowest, const Vector3d& highest) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(reach(part, Vector3d::Unit(axis)), highest[axis], 2e-8) << axis;
    EXPECT_NEAR(-reach(part, -Vector3d::Unit(axis)), lowest[axis], 2e-8) << axis;
  }
}

std::string robot(const std::string& elements) {
  return "<robot name='probe'>" + elements + "</robot>";
}

/// A robot of one link 'tip' with a collision shape.
std::string robot_of(const std::string& shape, const std::string& origin = "<origin/>") {
  return robot("<link name='tip'><collision>" + origin + "<geometry>" + shape +
               "</geometry></collision></link>");
}

std::string refusal(const std::string& urdf) {
  return tool_error([&] { RobotModel{urdf}; });
}

std::string refusal_of_tip(const std::string& urdf) {
  const RobotModel model(urdf);
  return tool_error([&] { model.link("tip"); });
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
  const Link shaft = gripper().link("shaft");
  EXPECT_EQ(shaft.name, "shaft");
  ASSERT_EQ(shaft.parts.size(), 2u);  // And not the visual box.
  EXPECT_NEAR(shaft.parts[0].core.rim.col(0).norm(), 0.004, 1e-15);
  expect_extent(shaft.parts[0], {-0.14, -0.024, 0.096}, {0.16, -0.016, 0.104});
  EXPECT_EQ(shaft.parts[1].radius, 0.005);
  expect_extent(shaft.parts[1], {0.155, -0.025, 0.095}, {0.165, -0.015, 0.105});
}

TEST(RobotModel, VisualShapesWhereThereAreNoOthers) {
  const Link wrist = gripper().link("wrist");
  ASSERT_EQ(wrist.parts.size(), 1u);
  expect_extent(wrist.parts[0], {0.48, 0.24, -0.155}, {0.52, 0.26, -0.095});
}

TEST(RobotModel, MeshesScaledAndPlaced) {
  const Link jaw = gripper().link("jaw");
  ASSERT_EQ(jaw.parts.size(), 1u);
  ASSERT_TRUE(jaw.parts[0].surface);
  EXPECT_EQ(jaw.parts[0].surface->faces().size(), 4u);
  expect_extent(jaw.parts[0], {0.092, 0.201, 0.306}, {0.098, 0.209, 0.32});

  const Link mirrored = gripper().link("other_jaw");
  expect_extent(mirrored.parts.at(0), {0.001, -0.008, 0.003}, {0.009, -0.002, 0.01});
}

TEST(RobotModel, MovingJoints) {
  const RobotModel model = gripper();
  EXPECT_EQ(model.moving_joint("mount"), "");
  EXPECT_EQ(model.moving_joint("shaft"), "insertion");
  EXPECT_EQ(model.moving_joint("wrist"), "");
  EXPECT_EQ(model.moving_joint("jaw"), "jaw_joint");
  EXPECT_EQ(model.moving_joint("other_jaw"), "other_jaw_joint");
}

TEST(RobotModel, WhatIsNoUrdfIsRefusedWithTheReason) {
  expect_words(refusal(""), {"no legal URDF", "empty"});
  expect_words(refusal("<robot name='probe'><link name='tip'></robot>"), {"end tag"});
  expect_words(refusal("<sdf/>"), {"'robot'"});
  expect_words(refusal(robot("<link name='a'/><link name='b'/>")), {"root", "[a]", "[b]"});
  expect_words(refusal(robot("<link name='a'/><link name='a'/>")), {"'a'", "not unique"});
}

TEST(RobotModel, UnknownLinksAreNamedWithTheNearest) {
  const RobotModel model = gripper();
  expect_words(tool_error([&] { model.link("jaws"); }),
               {"'jaws' is unknown", "nearest is 'jaw'", "jaw, mount, other_jaw, shaft, wrist"});
}

TEST(RobotModel, LinksWithoutShapeAreRefused) {
  const RobotModel model = gripper();
  expect_words(tool_error([&] { model.link("mount"); }), {"'mount'", "no collision or visual"});
}

TEST(RobotModel, IllegalSizesAreNamed) {
  expect_words(refusal_of_tip(robot_of("<sphere radius='0'/>")),
               {"'tip'", "sphere's radius is 0", "more than 0"});
  expect_words(refusal_of_tip(robot_of("<cylinder radius='-0.01' length='1'/>")),
               {"'tip'", "cylinder's radius is -0.01", "more than 0"});
  expect_words(refusal_of_tip(robot_of("<cylinder radius='0.01' length='0'/>")),
               {"'tip'", "cylinder's length is 0", "more than 0"});
  expect_words(refusal_of_tip(robot_of("<box size='1 -2 3'/>")),
               {"'tip'", "box's side is -2", "more than 0"});
  expect_words(refusal_of_tip(robot_of("<sphere radius='2e6'/>")), {"2e+06", "at most 1e+06 m"});
  expect_words(refusal_of_tip(robot_of("<sphere radius='1'/>", "<origin xyz='0 -1e7 0'/>")),
               {"'tip'", "origin", "-1e+07", "within 1e+06 m"});
}

TEST(RobotModel, LinksReadInPartAreRefused) {
  // urdfdom would leave out the second shape, and all that follow.
  const std::string first = "<link name='tip'><collision><geometry><sphere radius='1'/>";
  const std::string second = "</geometry></collision><collision><geometry>";
  const std::string end = "</geometry></collision></link>";
  for (const std::string shape :
       {"<sphere radius='nan'/>", "<cone/>", "<sphere/>", "<mesh filename='a' scale='1 1'/>"}) {
    expect_words(refusal_of_tip(robot(first + second + shape + end)), {"'tip'", "Link [tip]"});
  }
  expect_words(refusal_of_tip(robot_of("<sphere radius='nan'/>")), {"radius [nan]"});
  expect_words(refusal_of_tip(robot_of("<box size='1 1'/>")), {"[1 1]"});
}

TEST(RobotModel, FaultsOfOtherLinksDoNotMatter) {
  const RobotModel model(robot(
      "<link name='tip'><collision><geometry><sphere radius='1'/></geometry></collision></link>"
      "<link name='tip_2'><collision><geometry><cone/></geometry></collision></link>"
      "<joint name='j' type='fixed'><parent link='tip'/><child link='tip_2'/></joint>"));
  EXPECT_EQ(model.link("tip").parts.size(), 1u);
  expect_words(tool_error([&] { model.link("tip_2"); }), {"'tip_2'", "cone"});
}

TEST(RobotModel, MeshFaultsNameTheLinkAndTheFile) {
  expect_words(refusal_of_tip(robot_of("<mesh filename='package://organ_collision/no.stl'/>")),
               {"'tip'", "no.stl"});
  expect_words(
      refusal_of_tip(robot_of("<mesh filename='" + tool_file("jaw.obj") + "' scale='1 0 1'/>")),
      {"'tip'", "jaw.obj", "1 0 1"});
  expect_words(refusal_of_tip(robot_of("<mesh filename=''/>")), {"'tip'", "''"});
}

TEST(RobotModel, LogsNothingAndLeavesConsoleBridgeAsItWas) {
  SilentHandler handler;
  console_bridge::useOutputHandler(&handler);
  RobotModel{robot_of("<cone/>")};
  EXPECT_EQ(console_bridge::getOutputHandler(), &handler);
  refusal("");
  EXPECT_EQ(console_bridge::getOutputHandler(), &handler);
  EXPECT_TRUE(handler.texts.empty());
  console_bridge::noOutputHandler();
}
