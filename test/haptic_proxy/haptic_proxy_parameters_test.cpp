#include "haptic_proxy/haptic_proxy_parameters.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;
using XmlRpc::XmlRpcValue;

namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

XmlRpcValue tool(const std::string& name) {
  XmlRpcValue tool;
  tool["name"] = name;
  tool["trocar_frame"] = "trocar";
  tool["tip_frame"] = "tip";
  tool["radius"] = 0.005;
  return tool;
}

XmlRpcValue one_tool() {
  XmlRpcValue all;
  all["tools"][0] = tool("hook");
  return all;
}

std::string refusal(const XmlRpcValue& all) {
  try {
    parse_haptic_proxy_parameters(all);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

std::string refusal(const char* name, const XmlRpcValue& value) {
  XmlRpcValue all = one_tool();
  all[name] = value;
  return refusal(all);
}

}  // namespace

TEST(HapticProxyParameters, DefaultsAreTheDocumentedOnes) {
  const LoadedHapticProxyParameters loaded = parse_haptic_proxy_parameters(one_tool());
  const HapticProxyParameters& p = loaded.parameters;
  EXPECT_EQ(p.tools.size(), 1U);
  EXPECT_EQ(p.frame, "");
  EXPECT_EQ(p.stiffness, 300.0);
  EXPECT_EQ(p.damping, 0.0);
  EXPECT_EQ(p.max_force, kUnlimited);
  EXPECT_EQ(p.max_torque, kUnlimited);
  EXPECT_EQ(p.clearance, 1e-4);
  EXPECT_EQ(p.jump, 0.05);
  EXPECT_EQ(p.puncture_force, 0.0);
  EXPECT_EQ(p.friction, 0.0);
  EXPECT_EQ(p.pose_timeout_sec, 0.1);
  EXPECT_EQ(p.mesh_timeout_sec, 0.0);
  EXPECT_EQ(p.frame_timeout_sec, 0.5);
  EXPECT_EQ(p.picker.kind, PickerKind::kFeedback);
  EXPECT_EQ(p.picker.gl, GlPlatform::kAuto);
  EXPECT_EQ(p.max_faces, 2'000'000);
  EXPECT_EQ(p.diagnostic_period_sec, 1.0);
  EXPECT_EQ(p.realtime.priority, 0);
  EXPECT_FALSE(p.realtime.lock_memory);
  EXPECT_FALSE(p.realtime.awake_cores);
  EXPECT_TRUE(p.publish_tf);
  EXPECT_TRUE(loaded.misspelt.empty());
}

TEST(HapticProxyParameters, AllAreRead) {
  XmlRpcValue all = one_tool();
  all["frame"] = "/world";
  all["stiffness"] = 500;
  all["damping"] = 0.75;
  all["max_force"] = 3.5;
  all["max_torque"] = 0.25;
  all["clearance"] = 2e-4;
  all["jump"] = 0.02;
  all["puncture_force"] = 2;
  all["friction"] = 0.5;
  all["pose_timeout_sec"] = 0.05;
  all["mesh_timeout_sec"] = 4.0;
  all["frame_timeout_sec"] = 0.75;
  all["picker"] = "select";
  all["gl"] = "egl";
  all["max_faces"] = 1000;
  all["diagnostic_period"] = 0.5;
  all["realtime_priority"] = 40;
  all["lock_memory"] = true;
  all["awake_cores"] = true;
  all["publish_tf"] = false;
  const LoadedHapticProxyParameters loaded = parse_haptic_proxy_parameters(all);
  EXPECT_TRUE(loaded.misspelt.empty());
  const HapticProxyParameters& p = loaded.parameters;
  EXPECT_EQ(p.frame, "world");
  EXPECT_EQ(p.stiffness, 500.0);
  EXPECT_EQ(p.damping, 0.75);
  EXPECT_EQ(p.max_force, 3.5);
  EXPECT_EQ(p.max_torque, 0.25);
  EXPECT_EQ(p.clearance, 2e-4);
  EXPECT_EQ(p.jump, 0.02);
  EXPECT_EQ(p.puncture_force, 2.0);
  EXPECT_EQ(p.friction, 0.5);
  EXPECT_EQ(p.pose_timeout_sec, 0.05);
  EXPECT_EQ(p.mesh_timeout_sec, 4.0);
  EXPECT_EQ(p.frame_timeout_sec, 0.75);
  EXPECT_EQ(p.picker.kind, PickerKind::kSelect);
  EXPECT_EQ(p.picker.gl, GlPlatform::kEgl);
  EXPECT_EQ(p.max_faces, 1000);
  EXPECT_EQ(p.diagnostic_period_sec, 0.5);
  EXPECT_EQ(p.realtime.priority, 40);
  EXPECT_TRUE(p.realtime.lock_memory);
  EXPECT_TRUE(p.realtime.awake_cores);
  EXPECT_FALSE(p.publish_tf);
}

TEST(HapticProxyParameters, IllegalOnesAreRefusedWithNameValueAndRange) {
  EXPECT_EQ(refusal("stiffness", 0), "~stiffness is '0'; must be a number, more than 0");
  EXPECT_EQ(refusal("clearance", -1.5), "~clearance is '-1.5'; must be a number, more than 0");
  EXPECT_EQ(refusal("jump", 0.0), "~jump is '0'; must be a number, more than 0, or .inf");
  for (const char* name : {"damping", "puncture_force", "friction"}) {
    EXPECT_NE(refusal(name, -0.1), "accepted") << name;
    EXPECT_NE(refusal(name, kUnlimited), "accepted") << name;
    EXPECT_EQ(refusal(name, 0), "accepted") << name;
  }
  for (const char* name : {"max_force", "max_torque"}) {
    EXPECT_EQ(refusal(name, kUnlimited), "accepted") << name;
    EXPECT_NE(refusal(name, 0), "accepted") << name;
  }
  EXPECT_NE(refusal("pose_timeout_sec", 0), "accepted");
  EXPECT_NE(refusal("frame", "/"), "accepted");
  EXPECT_NE(refusal("picker", "bullet"), "accepted");
  EXPECT_NE(refusal(XmlRpcValue(3)), "accepted");
}

TEST(HapticProxyParameters, MisspeltNamesAreReported) {
  XmlRpcValue all = one_tool();
  all["stifness"] = 5.0;
  const std::vector<std::string> misspelt = parse_haptic_proxy_parameters(all).misspelt;
  ASSERT_EQ(misspelt.size(), 1U);
  EXPECT_NE(misspelt[0].find("stiffness"), std::string::npos) << misspelt[0];
}

TEST(HapticProxyParameters, ToolsWhoseTopicsWouldHaveOneNameAreRefused) {
  XmlRpcValue all;
  all["tools"][0] = tool("left hook");
  all["tools"][1] = tool("left_hook");
  const std::string error = refusal(all);
  EXPECT_NE(error.find("'left hook' and 'left_hook'"), std::string::npos) << error;
}

TEST(HapticProxyParameters, SomeCanBeChangedWhileTheNodeRuns) {
  const LiveHapticProxyParameters before;
  const std::vector<LiveParameter> live = live_parameters(before);
  ASSERT_EQ(live.size(), 10U);
  XmlRpcValue changes;
  for (const LiveParameter& parameter : live) changes[parameter.name] = 0.125;
  const LiveHapticProxyParameters after = changed(before, changes);
  for (const LiveParameter& parameter : live_parameters(after)) {
    EXPECT_EQ(static_cast<double>(XmlRpcValue(parameter.value)), 0.125) << parameter.name;
  }
  XmlRpcValue illegal;
  illegal["stiffness"] = -1.0;
  EXPECT_THROW(changed(before, illegal), ParameterError);
  XmlRpcValue fixed;
  fixed["pose_timeout_sec"] = 1.0;
  EXPECT_THROW(changed(before, fixed), ParameterError);
}

TEST(HapticProxyParameters, ForcesBecomeLengths) {
  LiveHapticProxyParameters p;
  p.stiffness = 200.0;
  p.puncture_force = 3.0;
  p.friction = 0.5;
  ToolParameters tool;
  tool.radius = 0.002;
  tool.freedom = ProxyFreedom::kTrocar;
  ProxySettings settings = proxy_settings(p, tool);
  EXPECT_EQ(settings.puncture, 0.015);
  EXPECT_EQ(settings.friction, 0.0025);
  p.puncture_force = 0.0;
  EXPECT_FALSE(proxy_settings(p, tool).puncture);
  p.puncture_force = 3.0;
  tool.freedom = ProxyFreedom::kFree;
  EXPECT_FALSE(proxy_settings(p, tool).puncture) << "a free tool pierces nothing";
}
