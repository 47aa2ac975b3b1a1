// The tables of parameters of haptic_proxy and organ_mesh_adapter.
#include "adapters/mesh_adapter_parameters.hpp"
#include "haptics/haptic_proxy_parameters.hpp"
#include "test/node/parameters/parameter_tables.hpp"

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

template <>
XmlRpcValue legal_parameters<MeshAdapterParameters>() {
  XmlRpcValue all;
  all["organs"].setSize(0);
  return all;
}

INSTANTIATE_TYPED_TEST_SUITE_P(HapticProxy, ParameterTableTest, HapticProxyParameters);
INSTANTIATE_TYPED_TEST_SUITE_P(MeshAdapter, ParameterTableTest, MeshAdapterParameters);

namespace {

XmlRpcValue organ(const std::string& name) {
  XmlRpcValue organ;
  organ["name"] = name;
  organ["topic"] = "sim/" + name;
  return organ;
}

XmlRpcValue kept(const XmlRpcValue& organ, const XmlRpcValue& side) {
  XmlRpcValue entry;
  entry["organ"] = organ;
  entry["side"] = side;
  return entry;
}

TEST(HapticParameters, AreTaken) {
  XmlRpcValue all = legal_parameters<HapticProxyParameters>();
  EXPECT_EQ(parse_parameters<HapticProxyParameters>(all).frame, "");
  all["frame"] = "/world";
  all["picker"] = "cpu";
  const auto proxy = parse_parameters<HapticProxyParameters>(all);
  EXPECT_EQ(proxy.frame, "world");
  EXPECT_EQ(proxy.picker.kind, PickerKind::kCpu);
  EXPECT_TRUE(proxy.keep.empty());
  all["keep"][0] = kept("left bladder", "inside");
  all["keep"][1] = kept("colon", "either");
  all["keep"][2] = kept("liver", "outside");
  all["keep"][2]["sides"] = "inside";
  const auto with = parse_parameters<HapticProxyParameters>(all);
  EXPECT_EQ(with.keep, (std::map<std::string, Side>{{"left bladder", Side::kInside},
                                                    {"colon", Side::kUnknown},
                                                    {"liver", Side::kOutside}}));
  ASSERT_EQ(with.misspelt.size(), 1U);
  expect_words(with.misspelt[0], {"~keep[2]/sides ", "'side'"});

  XmlRpcValue adapter;
  adapter["collision_node"] = "/theatre/collisions";
  adapter["organs"][0] = organ("liver");
  adapter["organs"][1] = organ("spleen");
  adapter["organs"][1]["frame"] = "/spleen_frame";
  adapter["organs"][1]["vertices_topic"] = "/sim/points";
  adapter["organs"][1]["frame_id"] = "liver";
  const MeshAdapterParameters meshes = parse_parameters<MeshAdapterParameters>(adapter);
  EXPECT_EQ(meshes.collision_node, "/theatre/collisions");
  ASSERT_EQ(meshes.organs.size(), 2u);
  EXPECT_EQ(meshes.organs[0].name, "liver");
  EXPECT_EQ(meshes.organs[0].topic, "sim/liver");
  EXPECT_EQ(meshes.organs[0].frame, "");
  EXPECT_EQ(meshes.organs[0].vertices_topic, "");
  EXPECT_EQ(meshes.organs[1].frame, "spleen_frame");
  EXPECT_EQ(meshes.organs[1].vertices_topic, "/sim/points");
  ASSERT_EQ(meshes.misspelt.size(), 1u);
  expect_words(meshes.misspelt[0], {"~organs[1]/frame_id ", "'frame'"});
  XmlRpcValue without_organs;
  without_organs["collision_node"] = "liver";
  EXPECT_THROW(parse_parameters<MeshAdapterParameters>(without_organs), ParameterError);
}

TEST(HapticParameters, IllegalOnesAreNamedWithTheirValueAndWhatIsLegal) {
  EXPECT_EQ(refusal_of<HapticProxyParameters>("frame", "/"),
            "~frame is '/'; must be the name of a TF frame");
  EXPECT_EQ(refusal_of<HapticProxyParameters>("clearance", -1.5),
            "~clearance is '-1.5'; must be a number, above 0, up to 0.1");
  EXPECT_EQ(refusal_of<HapticProxyParameters>("max_force", 0),
            "~max_force is '0'; must be a number, above 0, up to 10000, or .inf");
  XmlRpcValue keep;
  EXPECT_EQ(refusal_of<HapticProxyParameters>("keep", "inside"),
            "~keep is the text 'inside'; must be a list of groups of organ and side");
  keep[0] = kept("colon", "left");
  expect_words(refusal_of<HapticProxyParameters>("keep", keep), {"~keep[0]/side is 'left'"});
  keep[0] = kept("", "inside");
  expect_words(refusal_of<HapticProxyParameters>("keep", keep), {"~keep[0]/organ is ''"});
  keep[0] = keep[1] = kept("colon", "inside");
  expect_words(refusal_of<HapticProxyParameters>("keep", keep), {"~keep[1]/organ", "unique"});
  XmlRpcValue tools;
  tools[0] = tools[1] = legal_parameters<HapticProxyParameters>()["tools"][0];
  tools[1]["name"] = "left_hook";  // Its topics would have the same names.
  expect_words(refusal_of<HapticProxyParameters>("tools", tools),
               {"~tools has 'left hook' and 'left_hook'"});
  expect_words(refusal_of<MeshAdapterParameters>("collision_node", "a b"),
               {"~collision_node is 'a b'", "not private"});
  const struct {
    const char* name;  ///< of a member of the second organ
    XmlRpcValue value;
    std::vector<std::string> words;
  } rows[] = {
      {"name", "", {"not empty"}},
      {"name", "liver", {"liver", "unique"}},
      {"name", std::string(257, 'x'), {"256 bytes"}},
      {"frame", "a\nb", {"control characters"}},
      {"frame", "", {"not empty"}},
      {"frame", "/", {"'/'", "TF frame"}},
      {"topic", 3, {"'3'", "text"}},
      {"topic", "sim liver", {"sim liver", "name"}},
      {"topic", "~mesh", {"'~mesh'", "not private"}},
      {"topic", "sim/liver", {"sim/liver", "unique"}},
      {"topic", "sim/liver_points", {"unique"}},
      {"vertices_topic", "sim/spleen", {"sim/spleen", "unique"}},
      {"vertices_topic", "", {"not empty"}},
      {"scale", 0, {"'0'", "above 0"}},
      {"scale", -0.001, {"above 0"}},
      {"scale", kUnlimited, {"above 0"}},
      {"scale", "1e-3", {"without quotes"}},
  };
  for (const auto& row : rows) {
    XmlRpcValue organs;
    organs[0] = organ("liver");
    organs[0]["vertices_topic"] = "sim/liver_points";
    organs[1] = organ("spleen");
    organs[1][row.name] = row.value;
    const std::string refusal = refusal_of<MeshAdapterParameters>("organs", organs);
    expect_words(refusal, {std::string("~organs[1]/") + row.name});
    expect_words(refusal, row.words);
  }
}

TEST(HapticParameters, ForcesBecomeLengths) {
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
