#include "node/parameters/node_parameters.hpp"

#include "parameter_tables.hpp"

namespace organ_collision {

using XmlRpc::XmlRpcValue;

template <>
XmlRpcValue legal_parameters<NodeParameters>() {
  XmlRpcValue all;
  all["tools"][0]["name"] = "hook";
  all["tools"][0]["trocar_frame"] = "hook_trocar";
  all["tools"][0]["tip_frame"] = "hook_tip";
  all["tools"][0]["radius"] = 0.005;
  return all;
}

INSTANTIATE_TYPED_TEST_SUITE_P(CollisionNode, ParameterTableTest, NodeParameters);

namespace {

XmlRpcValue list_of(const std::vector<XmlRpcValue>& values) {
  XmlRpcValue list;
  list.setSize(static_cast<int>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) list[static_cast<int>(i)] = values[i];
  return list;
}

XmlRpcValue shaft() { return legal_parameters<NodeParameters>()["tools"][0]; }

XmlRpcValue links() {
  XmlRpcValue tool;
  tool["name"] = "PSM1";
  tool["links"] = list_of({"jaw", "other_jaw"});
  return tool;
}

ToolParameters parsed(const XmlRpcValue& tool) {
  XmlRpcValue all;
  all["tools"][0] = tool;
  return parse_parameters<NodeParameters>(all).tools.at(0);
}

std::string tool_refusal(const XmlRpcValue& tool) {
  return refusal_of<NodeParameters>("tools", list_of({tool}));
}

TEST(NodeParameters, PickersAreChosenByName) {
  XmlRpcValue all = legal_parameters<NodeParameters>();
  all["picker"] = "select";
  all["gl"] = "egl";
  const PickerSettings picker = parse_parameters<NodeParameters>(all).picker;
  EXPECT_EQ(picker.kind, PickerKind::kSelect);
  EXPECT_EQ(picker.gl, GlPlatform::kEgl);
  EXPECT_EQ(refusal_of<NodeParameters>("picker", "raytrace"),
            "~picker is 'raytrace'; must be one of feedback, select, cpu");
}

TEST(NodeParameters, RefusalsNameTheValueAndWhatIsLegal) {
  struct Row {
    const char* name;
    XmlRpcValue value;
    const char* legal;
  };
  const std::vector<Row> rows = {
      {"motion_sample_sec", 0.0, "'0'; must be a number, above 0"},
      {"motion_sample_sec", "2.5",
       "the text '2.5'; must be a number, above 0: write it without quotes"},
      {"motion_sample_sec", "5e-3",
       "the text '5e-3'; must be a number, above 0: write it without quotes"},
      {"motion_sample_sec", true, "is true; must be a number, above 0"},
      {"tf_timeout_sec", 60.0000001, "'60.0000001'; must be a number, 0 to 60"},
      {"markers_depth", kUnlimited, "'inf'; must be a number, above 0"},
      {"threads", 1025, "'1025'; must be a whole number, 0 to 1024"},
      {"threads", 2.0, "the number '2'; must be a whole number, 0 to 1024"},
      {"mesh_timeout_sec", 1e300, "0 to 1000000"},
      {"organ_motion", 1, "the number '1'; must be true or false"},
      {"rate", 1e-10, "'1e-10'; must be a number, 0, or 0.001 to 10000"},
      {"picker", 1, "the number '1'; must be one of feedback, select, cpu"},
      {"tools", list_of({"hook"}), "'hook'; must be a group of name"}};
  for (const Row& row : rows) {
    expect_words(refusal_of<NodeParameters>(row.name, row.value),
                 {std::string("~") + row.name, row.legal});
  }
  for (const char* name : {"motion_sample_sec", "threads", "rate"}) {  // Without a decimal point.
    EXPECT_EQ(refusal_of<NodeParameters>(name, 1), "accepted");
  }
}

TEST(NodeParameters, ToolsMustBeGivenAndHaveNamesOfTheirOwn) {
  expect_words(refusal_of<NodeParameters>("tools", "hook"), {"~tools", "hook", "list"});
  expect_words(refusal_of<NodeParameters>("tools", list_of({shaft(), shaft()})),
               {"~tools[1]/name", "hook", "unique"});
  XmlRpcValue none;
  none["rate"] = 1;
  EXPECT_THROW(parse_parameters<NodeParameters>(none), ParameterError);
  none["tools"].setSize(0);
  EXPECT_TRUE(parse_parameters<NodeParameters>(none).tools.empty());
}

TEST(NodeParameters, NamesThatAreGoneAreRefused) {
  expect_words(refusal_of<NodeParameters>("awake_cores", false), {"~awake_cores is gone"});
}

// Of a node they are reported. In a tool, one that has no effect might leave a default in force.
TEST(NodeParameters, MisspeltKeysOfToolsAreRefused) {
  XmlRpcValue all = legal_parameters<NodeParameters>();
  all["rates"] = 1;
  const std::vector<std::string> misspelt = parse_parameters<NodeParameters>(all).misspelt;
  ASSERT_EQ(misspelt.size(), 1u);
  expect_words(misspelt[0], {"~rates", "'rate'"});
  for (const HelpEntry& key : tool_keys()) {
    XmlRpcValue tool = shaft();
    tool[key.name + "s"] = 1;
    expect_words(tool_refusal(tool), {"~tools[0]/" + key.name + "s is no parameter; nearest is '" +
                                      key.name + "', legal are name, trocar_frame"});
  }
}

/// A key of a legal tool with an illegal value, and what the refusal says besides the key.
struct ToolRefusal {
  XmlRpcValue (*tool)();
  const char* key;
  XmlRpcValue value;
  std::vector<std::string> words;
};

TEST(ToolParameters, IllegalOnesAreNamedWithTheirValueAndWhatIsLegal) {
  const XmlRpcValue too_long = std::string(257, 'x');
  const std::vector<ToolRefusal> refusals = {
      {shaft, "radius", 0.0, {"'0'", "above 0, up to 1"}},
      {shaft, "radius", 2.5, {"'2.5'", "above 0, up to 1"}},
      {shaft, "radius", kUnlimited, {"inf", "above 0, up to 1"}},
      {shaft, "name", "", {"not empty"}},
      {shaft, "name", 7, {"the number '7'; must be a text that is not empty: write it in quotes"}},
      {shaft, "name", true, {"true; must be a text that is not empty: write it in quotes"}},
      {shaft, "tip_offset", list_of({0.1, 0.2}), {"three numbers, each from -2 to 2 [m]"}},
      {shaft,
       "tip_offset",
       list_of({0, 0, "5e-3"}),
       {"with the text '5e-3'", "three numbers", "write it without quotes"}},
      {links, "links", list_of({7}), {"with the number '7'", "write it in quotes"}},
      {shaft, "tip_offset", list_of({0, 0, std::nan("")}), {"three numbers"}},
      {shaft, "tip_offset", list_of({0, 0, 174.6}), {"174.6", "three numbers, each from -2"}},
      {shaft, "tip_offset", "0 0 1", {"the text '0 0 1'", "list of three numbers"}},
      {links, "tip_offset", list_of({0, 0, 1}), {"goes with tip_frame or tip_pose_topic"}},
      {links, "trocar_offset", list_of({0, 0, 1}), {"goes with trocar_frame"}},
      {shaft, "name", too_long, {"at most 256 bytes"}},
      {shaft, "name", "ho\nok", {"control characters"}},
      {shaft, "trocar_frame", too_long, {"at most 256 bytes"}},
      {shaft, "tip_frame", too_long, {"at most 256 bytes"}},
      {shaft, "tip_frame", "", {"not empty"}},
      {shaft, "tip_frame", "/", {"'/'", "TF frame"}},
      {shaft, "margin", -0.25, {"-0.25", "at least 0"}},
      {shaft, "margin", std::nan(""), {"nan", "at least 0"}},
      {shaft, "margin", kUnlimited, {"inf", "at least 0"}},
      {shaft, "margin", "wide", {"wide", "number"}},
      {shaft, "max_near", -1, {"-1", "0 to 1000000"}},
      {shaft, "max_near", 0.5, {"0.5", "whole"}},
      {shaft, "max_near", 7, {"'7'", "margin"}},
      {shaft, "freedom", "fixed", {"'fixed'", "trocar, free"}},
      {shaft, "tip_pose_topic", "a b", {"'a b'"}},
      {shaft, "tip_pose_topic", "~a", {"'~a'", "without ~"}},
      {shaft, "tip_pose_topic", "", {"not empty"}},
      {shaft, "base_pose_topic", "/base", {"'/base'", "tip_pose_topic"}},
      {shaft, "robot_description", "a", {"goes with links"}},
      {shaft, "urdf", "a", {"goes with links"}},
      {shaft, "tf_prefix", "a", {"goes with links"}},
      {shaft, "links", "jaw", {"'jaw'", "list"}},
      {shaft, "links", list_of({}), {"not empty"}},
      {shaft, "links", list_of({"jaw", "jaw"}), {"jaw", "each once"}},
      {shaft, "links", list_of({""}), {"not empty"}},
      {shaft, "links", list_of({"a", 1}), {"'{a,1}'", "not empty, of texts"}},
      {links, "links", list_of({too_long}), {"at most 256 bytes"}},
      {links, "first_jaw", "jaw", {"'jaw'", "list"}},
      {links,
       "first_jaw",
       list_of({"jaws"}),
       {"~tools[0]/first_jaw is '{jaws}'", "'jaws' is no link",
        "nearest is 'jaw', legal are jaw, other_jaw"}},
      {shaft, "second_jaw", list_of({"jaw"}), {"goes with links"}},
      {shaft, "grasp_gap", 0.004, {"goes with links"}},
      {links, "grasp_gap", 0.004, {"~tools[0]/grasp_gap", "goes with first_jaw"}},
      {links, "robot_description", "a b", {"'a b'"}},
      {links, "urdf", "", {"not empty"}},
      {links, "tf_prefix", "left/", {"'left/'", "slash"}},
      {links, "tf_prefix", "/", {"'/'", "slash"}},
      {links, "freedom", "trocar", {"'trocar'", "must be free"}},
      {links, "base_pose_topic", "/base", {"'/base'", "tip_pose_topic"}},
  };
  for (const ToolRefusal& row : refusals) {
    XmlRpcValue tool = row.tool();
    tool[row.key] = row.value;
    const std::string message = tool_refusal(tool);
    expect_words(message, {std::string("~tools[0]/") + row.key + " is "});
    expect_words(message, row.words);
  }
}

TEST(ToolParameters, WhatDoesNotGoTogetherIsNamed) {
  XmlRpcValue nothing;
  nothing["name"] = "PSM1";
  expect_words(tool_refusal(nothing), {"~tools[0]/links", "missing", "trocar_frame", "radius"});
  XmlRpcValue half = links();
  half["radius"] = 0.01;
  expect_words(tool_refusal(half), {"~tools[0]/trocar_frame", "missing"});
  half = links();
  half["trocar_frame"] = "a";
  expect_words(tool_refusal(half), {"~tools[0]/radius", "missing"});
  XmlRpcValue two = links();
  two["urdf"] = "/hook.urdf";
  two["robot_description"] = "robot_description";
  expect_words(tool_refusal(two), {"~tools[0]/robot_description", "beside urdf"});
  XmlRpcValue jaws = links();
  jaws["second_jaw"] = list_of({"other_jaw", "jaw"});
  expect_words(tool_refusal(jaws), {"~tools[0]/first_jaw is missing; must be a list"});
  jaws["first_jaw"] = list_of({"jaw"});
  EXPECT_EQ(tool_refusal(jaws),
            "~tools[0]/second_jaw is '{other_jaw,jaw}'; 'jaw' is in first_jaw, too; a link belongs "
            "to one jaw");
}

TEST(ToolParameters, ATipAtTheTrocarMakesABall) {
  XmlRpcValue tool = shaft();
  tool["tip_frame"] = "/hook_trocar";
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(parsed(tool).is_ball());
    EXPECT_EQ(parsed(tool).freedom, ProxyFreedom::kFree);
    tool["trocar_offset"] = tool["tip_offset"] = list_of({0, 0.1, 0.2});
  }
  tool["freedom"] = "trocar";
  expect_words(tool_refusal(tool), {"freedom", "free for a ball"});
  tool["tip_offset"] = list_of({0, 0, 0.2});
  EXPECT_FALSE(parsed(tool).is_ball());
}

}  // namespace
}  // namespace organ_collision
