#include "programs/replay/yaml_parameters.hpp"

#include <gtest/gtest.h>

#include "common/messages/robot_reply.hpp"
#include "temporary_files.hpp"

using namespace organ_collision;

namespace {

const std::string kTools = "tools: [{name: grip, links: [jaw]}]\n";

YamlParameters read_yaml(const std::string& text, const std::string& node = "/organ_collision") {
  const TemporaryFile file(text);
  return {file.path(), node};
}

}  // namespace

TEST(YamlParameters, HaveTheTypesOfTheParameterServer) {
  const NodeParameters parameters =
      read_yaml(
          "tools:\n"
          "  - {name: '7', trocar_frame: \"true\", tip_frame: y, radius: 5e-3}\n"
          "rate: 100\n"
          "tf_timeout_sec: 1\n"
          "publish_regions: yes\n"
          "mesh_timeout_sec: .5\n")
          .node_parameters();
  EXPECT_TRUE(parameters.misspelt.empty());
  ASSERT_EQ(parameters.tools.size(), 1u);
  EXPECT_EQ(parameters.tools[0].name, "7");
  EXPECT_EQ(parameters.tools[0].trocar_frame, "true");
  EXPECT_EQ(parameters.tools[0].tip_frame, "y");
  EXPECT_EQ(parameters.tools[0].radius, 0.005);
  EXPECT_EQ(parameters.rate_hz, 100.0);
  EXPECT_EQ(parameters.tf_timeout_sec, 1.0);
  EXPECT_EQ(parameters.mesh_timeout_sec, 0.5);
  EXPECT_TRUE(parameters.publish_regions);
}

TEST(YamlParameters, MisspeltNamesAreTold) {
  EXPECT_EQ(read_yaml(kTools + "rats: 7\n").node_parameters().misspelt.size(), 1u);
  EXPECT_TRUE(read_yaml(kTools + "robot_description: x\n").node_parameters().misspelt.empty());
}

TEST(YamlParameters, ARobotIsSearchedUpwards) {
  const std::string node = "organ_collision:\n  " + kTools;
  EXPECT_EQ(read_yaml(kTools + "robot_description: a\n").find_text("robot_description"), "a");
  EXPECT_EQ(read_yaml(node + "robot_description: b\n").find_text("robot_description"), "b");
  EXPECT_EQ(read_yaml(node + "  robot_description: c\nrobot_description: b\n")
                .find_text("robot_description"),
            "c");
  EXPECT_EQ(read_yaml(node + "robots: {left: d}\n").find_text("robots/left"), "d");
  EXPECT_EQ(read_yaml(node + "  robots: {right: e}\nrobots: {left: d}\n").find_text("/robots/left"),
            "d");
  const std::string deep = "arm:\n  robot_description: f\n  contacts:\n    " + kTools;
  EXPECT_EQ(read_yaml(deep, "/arm/contacts").find_text("robot_description"), "f");
}

TEST(YamlParameters, AMissingRobotIsAnError) {
  EXPECT_THROW(read_yaml(kTools).find_text("robot_description"), ToolError);
  EXPECT_THROW(read_yaml(kTools + "robots: {left: d}\n").find_text("robots/right"), ToolError);
  EXPECT_THROW(read_yaml(kTools + "robot_description: [d]\n").find_text("robot_description"),
               ToolError);
}

TEST(YamlParameters, RefusesWhatIsNoParameters) {
  for (const char* text : {"", "7", "- a\n", "tools: [", "tools: !degrees 7\n", "tools:\n",
                           "tools: &a {b: *a}\n", "{[a]: b}\n"}) {
    EXPECT_THROW(read_yaml(text), InputError) << text;
  }
}
