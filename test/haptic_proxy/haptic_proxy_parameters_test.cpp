#include "haptic_proxy/haptic_proxy_parameters.hpp"

#include "test/ros/parameters/parameter_tables.hpp"

namespace organ_collision {

using XmlRpc::XmlRpcValue;

template <>
XmlRpcValue legal_parameters<HapticProxyParameters>() {
  XmlRpcValue all;
  all["tools"][0]["name"] = "left hook";
  all["tools"][0]["trocar_frame"] = "trocar";
  all["tools"][0]["tip_frame"] = "tip";
  all["tools"][0]["radius"] = 0.005;
  return all;
}

INSTANTIATE_TYPED_TEST_SUITE_P(HapticProxy, ParameterTableTest, HapticProxyParameters);

namespace {

TEST(HapticProxyParameters, TheFrameAndThePickerAreTaken) {
  XmlRpcValue all = legal_parameters<HapticProxyParameters>();
  EXPECT_EQ(parse_parameters<HapticProxyParameters>(all).frame, "");
  all["frame"] = "/world";
  all["picker"] = "cpu";
  const auto parameters = parse_parameters<HapticProxyParameters>(all);
  EXPECT_EQ(parameters.frame, "world");
  EXPECT_EQ(parameters.picker.kind, PickerKind::kCpu);
  EXPECT_EQ(refusal_of<HapticProxyParameters>("frame", "/"),
            "~frame is '/'; must be the name of a TF frame");
}

TEST(HapticProxyParameters, RefusalsSayWhatIsLegal) {
  EXPECT_EQ(refusal_of<HapticProxyParameters>("clearance", -1.5),
            "~clearance is '-1.5'; must be a number, more than 0");
  EXPECT_EQ(refusal_of<HapticProxyParameters>("jump", 0.0),
            "~jump is '0'; must be a number, more than 0, or .inf");
}

TEST(HapticProxyParameters, ToolsWhoseTopicsWouldHaveOneNameAreRefused) {
  const XmlRpcValue tool = legal_parameters<HapticProxyParameters>()["tools"][0];
  XmlRpcValue tools;
  tools[0] = tools[1] = tool;
  tools[1]["name"] = "left_hook";
  expect_contains(refusal_of<HapticProxyParameters>("tools", tools),
                  {"~tools has 'left hook' and 'left_hook'"});
}

TEST(HapticProxyParameters, ForcesBecomeLengths) {
  HapticProxyParameters p;
  p.stiffness = 200.0;
  p.puncture_force = 3.0;
  p.friction = 0.5;
  ToolParameters tool;
  tool.radius = 0.002;
  tool.freedom = ProxyFreedom::kTrocar;
  const ProxySettings settings = proxy_settings(p, tool);
  EXPECT_EQ(settings.puncture, 0.015);
  EXPECT_EQ(settings.friction, 0.0025);
  p.puncture_force = 0.0;
  EXPECT_FALSE(proxy_settings(p, tool).puncture);
  p.puncture_force = 3.0;
  tool.freedom = ProxyFreedom::kFree;
  EXPECT_FALSE(proxy_settings(p, tool).puncture) << "a free tool pierces nothing";
}

}  // namespace
}  // namespace organ_collision
