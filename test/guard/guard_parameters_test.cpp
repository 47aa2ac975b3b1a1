// The table of parameters of tool_guard.
#include "guard/guard_parameters.hpp"

#include "test/node/parameters/parameter_tables.hpp"

namespace organ_collision {

using XmlRpc::XmlRpcValue;

template <>
XmlRpcValue legal_parameters<GuardParameters>() {
  XmlRpcValue all;
  all.begin();  // Makes it an empty group.
  return all;
}

INSTANTIATE_TYPED_TEST_SUITE_P(ToolGuard, ParameterTableTest, GuardParameters);

namespace {

XmlRpcValue row(const char* key, const std::string& value, const std::string& organ = "liver") {
  XmlRpcValue list;
  list[0]["organ"] = organ;
  list[0][key] = value;
  return list;
}

// The receiver of the states has these, too. Were one changed here alone, the receiver would move
// the tool faster than the guard allows.
TEST(GuardParameters, WhatTheReceiverHasAsWellIsNotLive) {
  GuardParameters parameters;
  const ParameterTable table = table_of(parameters);
  for (const std::string name : {"max_speed", "retreat_speed", "watch_time"}) {
    XmlRpcValue change;
    change[name] = 0.05;
    expect_words(refusal_by<ParameterError>([&] { table.change(change); }), {name});
  }
  XmlRpcValue change;
  change["latency"] = 0.3;
  table.change(change);
  EXPECT_EQ(parameters.latency, 0.3);
}

TEST(GuardParameters, IllegalOnesAreNamedWithTheirValue) {
  const auto refusal = refusal_of<GuardParameters>;
  expect_words(refusal("error", 0.002), {"~error", "~stop_distance"});
  expect_words(refusal("tools", "hook"), {"~tools is the text 'hook'"});
  expect_words(refusal("keep", row("side", "left")), {"~keep[0]/side is 'left'"});
  expect_words(refusal("keep", row("side", "inside", "")), {"~keep[0]/organ is ''"});
  XmlRpcValue twice = row("side", "inside");
  twice[1] = row("side", "inside")[0];
  expect_words(refusal("keep", twice), {"~keep[1]/organ", "unique"});
  expect_words(refusal("touch_allowed", "jaw"), {"~touch_allowed is the text 'jaw'"});
  expect_words(refusal("touch_allowed", row("organ", "liver")),
               {"~touch_allowed[0]/link is missing"});
}

}  // namespace
}  // namespace organ_collision
