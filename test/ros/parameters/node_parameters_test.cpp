#include "ros/parameters/node_parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace organ_collision;
using XmlRpc::XmlRpcValue;

namespace {

XmlRpcValue tool(const std::string& name) {
  XmlRpcValue tool;
  tool["name"] = name;
  tool["trocar_frame"] = name + "_trocar";
  tool["tip_frame"] = name + "_tip";
  tool["radius"] = 0.005;
  return tool;
}

XmlRpcValue one_tool() {
  XmlRpcValue all;
  all["tools"][0] = tool("hook");
  return all;
}

/// The error for a node with one legal tool and `name` set to `value`.
std::string refusal(const char* name, const XmlRpcValue& value) {
  XmlRpcValue all = one_tool();
  all[name] = value;
  try {
    parse_parameters(all);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

std::string refusal_of_tool(const char* name, const XmlRpcValue& value) {
  XmlRpcValue tools;
  tools[0] = tool("hook");
  tools[0][name] = value;
  return refusal("tools", tools);
}

/// The error for a tool that is one link.
std::string refusal_of_links(const char* name, const XmlRpcValue& value) {
  XmlRpcValue tools;
  tools[0]["name"] = "PSM1";
  tools[0]["links"][0] = "jaw";
  tools[0][name] = value;
  return refusal("tools", tools);
}

void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' in: " << message;
  }
}

}  // namespace

TEST(Parameters, DefaultsAreTheDocumentedOnes) {
  const LoadedParameters loaded = parse_parameters(one_tool());
  const NodeParameters& p = loaded.parameters;
  EXPECT_EQ(p.picker.kind, PickerKind::kFeedback);
  EXPECT_EQ(p.picker.gl, GlPlatform::kAuto);
  EXPECT_EQ(p.rate_hz, 0.0);
  EXPECT_TRUE(p.organ_motion);
  EXPECT_EQ(p.motion_sample_sec, 0.001);
  EXPECT_EQ(p.motion_samples_max, 100);
  EXPECT_EQ(p.tf_timeout_sec, 0.02);
  EXPECT_EQ(p.mesh_timeout_sec, 0.0);
  EXPECT_EQ(p.max_faces, 2'000'000);
  EXPECT_EQ(p.max_batch, 100'000);
  EXPECT_EQ(p.max_batch_bytes, 268'435'456);
  EXPECT_FALSE(p.publish_regions);
  EXPECT_TRUE(p.publish_placement);
  EXPECT_EQ(p.tools.at(0).margin, 0.0);
  EXPECT_EQ(p.tools.at(0).max_near, 0);
  EXPECT_EQ(p.diagnostic_period_sec, 1.0);
  EXPECT_EQ(p.realtime.priority, 0);
  EXPECT_FALSE(p.realtime.lock_memory);
  EXPECT_FALSE(p.realtime.awake_cores);
  EXPECT_EQ(p.markers.markers_rate_hz, 30.0);
  EXPECT_EQ(p.markers.surface_rate_hz, 30.0);
  EXPECT_EQ(p.markers.markers_depth, 0.01);
  EXPECT_TRUE(loaded.misspelt.empty());
}

TEST(Parameters, EveryValueIsTaken) {
  XmlRpcValue all = one_tool();
  all["tools"][1] = tool("grasper");
  all["tools"][1]["radius"] = 1;
  all["picker"] = "select";
  all["gl"] = "egl";
  all["rate"] = 500;
  all["organ_motion"] = false;
  all["motion_sample_sec"] = 0.5;
  all["motion_samples_max"] = 7;
  all["tf_timeout_sec"] = 0;
  all["mesh_timeout_sec"] = 1.5;
  all["max_faces"] = 1224;
  all["max_batch"] = 20'000;
  all["max_batch_bytes"] = 4096;
  all["publish_regions"] = true;
  all["publish_placement"] = false;
  all["tools"][1]["margin"] = 0.02;
  all["tools"][1]["max_near"] = 50;
  all["diagnostic_period"] = 0.25;
  all["realtime_priority"] = 99;
  all["lock_memory"] = true;
  all["awake_cores"] = true;
  const LoadedParameters loaded = parse_parameters(all);
  EXPECT_TRUE(loaded.misspelt.empty());
  const NodeParameters& p = loaded.parameters;
  ASSERT_EQ(p.tools.size(), 2u);
  EXPECT_EQ(p.tools[0].name, "hook");
  EXPECT_EQ(p.tools[1].trocar_frame, "grasper_trocar");
  EXPECT_EQ(p.tools[1].tip_frame, "grasper_tip");
  EXPECT_EQ(p.tools[1].radius, 1.0);
  EXPECT_EQ(p.picker.kind, PickerKind::kSelect);
  EXPECT_EQ(p.picker.gl, GlPlatform::kEgl);
  EXPECT_EQ(p.rate_hz, 500.0);
  EXPECT_FALSE(p.organ_motion);
  EXPECT_EQ(p.motion_sample_sec, 0.5);
  EXPECT_EQ(p.motion_samples_max, 7);
  EXPECT_EQ(p.tf_timeout_sec, 0.0);
  EXPECT_EQ(p.mesh_timeout_sec, 1.5);
  EXPECT_EQ(p.max_faces, 1224);
  EXPECT_EQ(p.max_batch, 20'000);
  EXPECT_EQ(p.max_batch_bytes, 4096);
  EXPECT_TRUE(p.publish_regions);
  EXPECT_FALSE(p.publish_placement);
  EXPECT_EQ(p.tools[0].margin, 0.0);
  EXPECT_EQ(p.tools[1].margin, 0.02);
  EXPECT_EQ(p.tools[1].max_near, 50);
  EXPECT_EQ(p.diagnostic_period_sec, 0.25);
  EXPECT_EQ(p.realtime.priority, 99);
  EXPECT_TRUE(p.realtime.lock_memory);
  EXPECT_TRUE(p.realtime.awake_cores);
}

TEST(Parameters, IllegalOnesAreNamedWithTheirValueAndWhatIsLegal) {
  const double nan = std::nan("");
  expect_words(refusal("picker", "raytrace"), {"~picker", "raytrace", "feedback", "select"});
  expect_words(refusal("rate", -1.5), {"~rate", "-1.5", "at least 0"});
  expect_words(refusal("rate", nan), {"~rate", "nan", "at least 0"});
  expect_words(refusal("rate", "fast"), {"~rate", "fast", "number"});
  expect_words(refusal("organ_motion", 1), {"~organ_motion", "'1'", "true or false"});
  expect_words(refusal("motion_sample_sec", 0.0), {"~motion_sample_sec", "more than 0"});
  expect_words(refusal("motion_samples_max", 0), {"~motion_samples_max", "at least 1"});
  expect_words(refusal("tf_timeout_sec", -0.1), {"~tf_timeout_sec", "-0.1", "at least 0"});
  expect_words(refusal("mesh_timeout_sec", -2), {"~mesh_timeout_sec", "-2", "at least 0"});
  expect_words(refusal("max_faces", 0), {"~max_faces", "at least 1", "83333333"});
  expect_words(refusal("max_batch", 0), {"~max_batch", "at least 1", "1000000"});
  expect_words(refusal("max_batch_bytes", 0), {"~max_batch_bytes", "at least 1", "1000000000"});
  expect_words(refusal("publish_regions", "often"), {"~publish_regions", "often"});
  expect_words(refusal("publish_placement", 1), {"~publish_placement", "'1'", "true or false"});
  expect_words(refusal("diagnostic_period", 0.0), {"~diagnostic_period", "'0'", "at least 0.01"});
  expect_words(refusal("threads", -1), {"~threads", "'-1'", "at least 0, at most 1024"});
  expect_words(refusal("realtime_priority", 100),
               {"~realtime_priority", "'100'", "at least 0, at most 99"});
  expect_words(refusal("realtime_priority", 40.0), {"~realtime_priority", "whole number"});
  expect_words(refusal("lock_memory", 1), {"~lock_memory", "'1'", "true or false"});
  expect_words(refusal("awake_cores", 1), {"~awake_cores", "'1'", "true or false"});
  expect_words(refusal("tools", "hook"), {"~tools", "hook", "list"});
}

TEST(Parameters, IllegalToolsAreNamed) {
  const double infinity = std::numeric_limits<double>::infinity();
  expect_words(refusal_of_tool("radius", 0.0), {"~tools[0]/radius", "'0'", "more than 0"});
  expect_words(refusal_of_tool("radius", infinity), {"~tools[0]/radius", "inf", "more than 0"});
  expect_words(refusal_of_tool("name", ""), {"~tools[0]/name", "not empty"});
  const std::string too_long(257, 'x');
  for (const char* name : {"name", "trocar_frame", "tip_frame"}) {
    expect_words(refusal_of_tool(name, too_long), {name, "at most 256 bytes"});
  }
  expect_words(refusal_of_tool("name", "ho\nok"), {"~tools[0]/name", "control characters"});
  XmlRpcValue links;
  links[0] = too_long;
  expect_words(refusal_of_links("links", links), {"~tools[0]/links", "at most 256 bytes"});
  expect_words(refusal_of_tool("tip_frame", ""), {"~tools[0]/tip_frame", "not empty"});
  expect_words(refusal_of_tool("tip_frame", "/"), {"~tools[0]/tip_frame", "'/'"});
  expect_words(refusal_of_tool("tip_frame", "hook_trocar"),
               {"~tools[0]/tip_frame", "hook_trocar", "other"});
  expect_words(refusal_of_tool("tip_frame", "/hook_trocar"),
               {"~tools[0]/tip_frame", "hook_trocar", "other"});
}

TEST(Parameters, ToolsMayBeLinks) {
  XmlRpcValue all;
  all["tools"][0]["name"] = "PSM1";
  all["tools"][0]["links"][0] = "jaw";
  all["tools"][0]["links"][1] = "other_jaw";
  const ToolParameters plain = parse_parameters(all).parameters.tools[0];
  EXPECT_EQ(plain.links, (std::vector<std::string>{"jaw", "other_jaw"}));
  EXPECT_EQ(plain.robot_description, "robot_description");
  EXPECT_EQ(plain.urdf, "");
  EXPECT_EQ(plain.link_frame("jaw"), "jaw");
  EXPECT_FALSE(plain.has_shaft());

  all["tools"][0]["robot_description"] = "/PSM1/robot_description";
  all["tools"][0]["tf_prefix"] = "/left";
  const ToolParameters named = parse_parameters(all).parameters.tools[0];
  EXPECT_EQ(named.robot_description, "/PSM1/robot_description");
  EXPECT_EQ(named.link_frame("jaw"), "left/jaw");

  all["tools"][0] = tool("hook");
  all["tools"][0]["links"][0] = "jaw";
  all["tools"][0]["urdf"] = "package://hooks/hook.urdf";
  const ToolParameters both = parse_parameters(all).parameters.tools[0];
  EXPECT_EQ(both.urdf, "package://hooks/hook.urdf");
  EXPECT_EQ(both.robot_description, "");
  EXPECT_EQ(both.links, std::vector<std::string>{"jaw"});
  EXPECT_TRUE(both.has_shaft());
  EXPECT_EQ(both.trocar_frame, "hook_trocar");
}

TEST(Parameters, LinksMayHaveATip) {
  XmlRpcValue all;
  all["tools"][0]["name"] = "PSM1";
  all["tools"][0]["links"][0] = "jaw";
  EXPECT_FALSE(parse_parameters(all).parameters.tools[0].has_tip_of_links());
  all["tools"][0]["tip_frame"] = "/jaw_tip";
  const ToolParameters tool = parse_parameters(all).parameters.tools[0];
  EXPECT_EQ(tool.tip_frame, "jaw_tip");
  EXPECT_TRUE(tool.has_tip_of_links());
  EXPECT_FALSE(tool.has_shaft());
  EXPECT_FALSE(parse_parameters(one_tool()).parameters.tools[0].has_tip_of_links());
}

TEST(Parameters, IllegalMarginsAreNamed) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  expect_words(refusal_of_tool("margin", -0.25), {"~tools[0]/margin", "-0.25", "at least 0"});
  expect_words(refusal_of_tool("margin", nan), {"~tools[0]/margin", "nan", "at least 0"});
  expect_words(refusal_of_tool("margin", infinity), {"~tools[0]/margin", "inf", "at least 0"});
  expect_words(refusal_of_tool("margin", "wide"), {"~tools[0]/margin", "wide", "number"});
  expect_words(refusal_of_tool("max_near", -1), {"~tools[0]/max_near", "-1", "at least 0"});
  expect_words(refusal_of_tool("max_near", 0.5), {"~tools[0]/max_near", "0.5", "whole"});
  expect_words(refusal_of_tool("max_near", 7), {"~tools[0]/max_near", "'7'", "margin"});
}

TEST(Parameters, IllegalLinksAreNamed) {
  XmlRpcValue empty, twice, unnamed;
  empty.setSize(0);
  twice[0] = twice[1] = "jaw";
  unnamed[0] = "";
  expect_words(refusal_of_tool("links", "jaw"), {"~tools[0]/links", "'jaw'", "list"});
  expect_words(refusal_of_tool("links", empty), {"~tools[0]/links", "not empty"});
  expect_words(refusal_of_tool("links", twice), {"~tools[0]/links", "jaw", "each once"});
  expect_words(refusal_of_tool("links", unnamed), {"~tools[0]/links", "not empty"});

  expect_words(refusal_of_links("robot_description", "a b"),
               {"~tools[0]/robot_description", "'a b'"});
  expect_words(refusal_of_links("urdf", ""), {"~tools[0]/urdf", "not empty"});
  expect_words(refusal_of_links("tf_prefix", "left/"), {"~tools[0]/tf_prefix", "'left/'", "slash"});
  expect_words(refusal_of_links("tf_prefix", "/"), {"~tools[0]/tf_prefix", "'/'", "slash"});
}

TEST(Parameters, WhatDoesNotGoTogetherIsNamed) {
  XmlRpcValue tools;
  tools[0]["name"] = "PSM1";
  expect_words(refusal("tools", tools), {"~tools[0]/links", "missing", "trocar_frame", "radius"});
  expect_words(refusal_of_links("radius", 0.01), {"~tools[0]/trocar_frame", "missing"});
  expect_words(refusal_of_links("trocar_frame", "a"), {"~tools[0]/radius", "missing"});
  expect_words(refusal_of_links("base_pose_topic", "/base"),
               {"~tools[0]/base_pose_topic", "'/base'", "tip_pose_topic"});
  for (const char* name : {"robot_description", "urdf", "tf_prefix"}) {
    expect_words(refusal_of_tool(name, "a"), {std::string("~tools[0]/") + name, "links"});
  }
  tools[0]["links"][0] = "jaw";
  tools[0]["urdf"] = "/hook.urdf";
  tools[0]["robot_description"] = "robot_description";
  expect_words(refusal("tools", tools), {"~tools[0]/robot_description", "beside urdf"});
}

TEST(Parameters, TipsMayComeAsPoses) {
  XmlRpcValue all = one_tool();
  all["tools"][0]["tip_pose_topic"] = "/PSM1/measured_cp";
  all["tools"][0]["base_pose_topic"] = "/PSM1/base";
  const ToolParameters named = parse_parameters(all).parameters.tools[0];
  EXPECT_EQ(named.tip_pose_topic, "/PSM1/measured_cp");
  EXPECT_EQ(named.base_pose_topic, "/PSM1/base");
  EXPECT_EQ(named.tip_frame, "hook_tip");

  XmlRpcValue unnamed;
  unnamed["name"] = "PSM1";
  unnamed["trocar_frame"] = "PSM1_base";
  unnamed["radius"] = 0.004;
  unnamed["tip_pose_topic"] = "PSM1/measured_cp";
  all["tools"][0] = unnamed;
  EXPECT_EQ(parse_parameters(all).parameters.tools[0].tip_frame, "PSM1_tip");

  expect_words(refusal_of_tool("tip_pose_topic", "a b"), {"~tools[0]/tip_pose_topic", "'a b'"});
  expect_words(refusal_of_tool("tip_pose_topic", ""), {"~tools[0]/tip_pose_topic", "not empty"});
  expect_words(refusal_of_tool("base_pose_topic", "/base"),
               {"~tools[0]/base_pose_topic", "'/base'", "tip_pose_topic"});
}

TEST(Parameters, LinksMayComeAsPoses) {
  XmlRpcValue all;
  all["tools"][0]["name"] = "stylus";
  all["tools"][0]["links"][0] = "pen";
  all["tools"][0]["tf_prefix"] = "left";
  all["tools"][0]["tip_pose_topic"] = "/stylus/measured_cp";
  const ToolParameters first_link = parse_parameters(all).parameters.tools[0];
  EXPECT_EQ(first_link.tip_frame, "left/pen");
  EXPECT_FALSE(first_link.has_shaft());

  all["tools"][0]["tip_frame"] = "/pen_base";
  const ToolParameters named = parse_parameters(all).parameters.tools[0];
  EXPECT_EQ(named.tip_frame, "pen_base");
  EXPECT_FALSE(named.has_shaft());
}

TEST(Parameters, ToolNamesAreUnique) {
  XmlRpcValue tools;
  tools[0] = tool("hook");
  tools[1] = tool("hook");
  expect_words(refusal("tools", tools), {"~tools[1]/name", "hook", "unique"});
}

TEST(Parameters, ToolsMustBeGiven) {
  XmlRpcValue none;
  none["rate"] = 1;
  EXPECT_THROW(parse_parameters(none), ParameterError);
  none["tools"].setSize(0);
  EXPECT_TRUE(parse_parameters(none).parameters.tools.empty());
}

TEST(Parameters, MisspeltNamesAreReported) {
  XmlRpcValue all = one_tool();
  all["mesh_timout_sec"] = 1.0;
  all["tools"][0]["colour"] = "red";
  const std::vector<std::string> misspelt = parse_parameters(all).misspelt;
  ASSERT_EQ(misspelt.size(), 2u);
  expect_words(misspelt[0], {"~mesh_timout_sec", "'mesh_timeout_sec'"});
  expect_words(misspelt[1], {"~tools[0]/colour", "radius"});
}

TEST(LiveNodeParameters, ChangesKeepTheRest) {
  LiveNodeParameters before;
  before.rate_hz = 50.0;
  XmlRpcValue changes;
  changes["tf_timeout_sec"] = 1;
  changes["publish_regions"] = true;
  changes["publish_placement"] = false;
  const LiveNodeParameters after = changed(before, changes);
  EXPECT_EQ(after.rate_hz, 50.0);
  EXPECT_EQ(after.tf_timeout_sec, 1.0);
  EXPECT_EQ(after.mesh_timeout_sec, before.mesh_timeout_sec);
  EXPECT_TRUE(after.publish_regions);
  EXPECT_FALSE(after.publish_placement);
}

TEST(LiveNodeParameters, IllegalChangesAreRefused) {
  const std::vector<std::pair<const char*, XmlRpcValue>> illegal = {
      {"rate", -1.0},           {"rate", 10'001.0},       {"rate", std::nan("")},
      {"tf_timeout_sec", 61},   {"mesh_timeout_sec", -1}, {"mesh_timeout_sec", 1.0 / 0.0},
      {"publish_regions", 1.0}, {"picker", "select"},     {"rates", 1.0}};
  for (const auto& [name, value] : illegal) {
    XmlRpcValue changes;
    changes[name] = value;
    EXPECT_THROW(changed({}, changes), ParameterError) << name;
  }
}

TEST(LiveNodeParameters, EachIsDescribed) {
  LiveNodeParameters now;
  now.rate_hz = 50.0;
  const std::vector<LiveParameter> all = live_parameters(now);
  EXPECT_EQ(all.size(), 8u);
  for (LiveParameter parameter : all) {
    EXPECT_FALSE(parameter.text.empty()) << parameter.name;
    XmlRpcValue changes;
    changes[parameter.name] = parameter.value;
    EXPECT_NO_THROW(changed(now, changes)) << parameter.name;
  }
}

TEST(Parameters, VerySlowRatesAreRefused) {
  for (const char* name : {"rate", "markers_rate", "surface_rate"}) {
    expect_words(refusal(name, 1e-10), {name, "1e-10", "0.001"});
  }
}

TEST(Parameters, OfMarkers) {
  XmlRpcValue all = one_tool();
  all["markers_rate"] = 60;
  all["surface_rate"] = 0;
  all["markers_depth"] = 0.02;
  const MarkerSettings markers = parse_parameters(all).parameters.markers;
  EXPECT_EQ(markers.markers_rate_hz, 60.0);
  EXPECT_EQ(markers.surface_rate_hz, 0.0);
  EXPECT_EQ(markers.markers_depth, 0.02);
  expect_words(refusal("markers_rate", -1.0), {"markers_rate", "-1", "0", "1000"});
  expect_words(refusal("surface_rate", 2000), {"surface_rate", "2000", "1000"});
  expect_words(refusal("markers_depth", 0.0), {"markers_depth", "0"});
}
