#include "ros/publishing/diagnostics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "ros/publishing/counters.hpp"
#include "test/ros/steps/node_parts.hpp"

using namespace organ_collision;
using diagnostic_msgs::DiagnosticStatus;

namespace {

class InboxDiagnosticsTest : public testing::Test, protected NodeParts {
 protected:
  using Task = void (InboxDiagnostics::*)(diagnostic_updater::DiagnosticStatusWrapper&);

  std::map<std::string, std::string> values(Task task) {
    status = {};
    (diagnostics.*task)(status);
    std::map<std::string, std::string> values;
    for (const auto& pair : status.values) values[pair.key] = pair.value;
    return values;
  }

  NodeCounters counters;
  diagnostic_updater::DiagnosticStatusWrapper status;
  InboxDiagnostics diagnostics{{parameters.mesh_timeout_sec, tools, organs, organ_topics,
                                counters.meshes, counters.rejected}};
};

}  // namespace

TEST_F(InboxDiagnosticsTest, RejectedMessagesByReason) {
  EXPECT_TRUE(values(&InboxDiagnostics::messages).count("mesh rate [1/s]"));
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  counters.rejected.add("wrong size", "7 numbers", now);
  counters.rejected.add("wrong size", "8 numbers", now);
  EXPECT_EQ(values(&InboxDiagnostics::messages).at("rejected, wrong size"), "2");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "8 numbers");
  EXPECT_EQ(values(&InboxDiagnostics::messages).at("rejected, wrong size"), "2");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);  // No new failure.
}

TEST_F(InboxDiagnosticsTest, WhatBecameOfOrganMessages) {
  send_mesh(48.0, 0.0);
  send_vertices(48.1, 0.1F);
  send_vertices(48.2, std::nanf(""));
  auto shown = values(&InboxDiagnostics::messages);
  EXPECT_EQ(shown.at("organ messages received"), "3");
  EXPECT_EQ(shown.at("organ messages applied"), "2");
  EXPECT_EQ(shown.at("organ messages refused"), "1");
  EXPECT_EQ(shown.at("organ messages that remove"), "0");
  EXPECT_EQ(shown.at("organ messages dropped behind a large mesh"), "0");
  EXPECT_EQ(shown.at("organ messages waiting"), "0");
  EXPECT_EQ(shown.at("organ messages lost before they came"), "0");
}

TEST_F(InboxDiagnosticsTest, AToolWithAFaultIsAnError) {
  tools.push_back(grasper());
  auto shown = values(&InboxDiagnostics::tools);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(status.message, "2 tools");
  EXPECT_EQ(shown.at("hook, radius of the shaft [m]"), "0.01");
  EXPECT_FALSE(shown.count("hook, links")) << "a shaft has none";
  EXPECT_EQ(shown.at("grasper, links"), "2");
  tools.push_back(shaft_tool("needle", 0.001));
  tools[1].fault = "grasper: parameter 'robot_description' is not set";
  values(&InboxDiagnostics::tools);
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_NE(status.message.find(tools[1].fault), std::string::npos) << status.message;
}

TEST_F(InboxDiagnosticsTest, OneToolIsCountedAndAnImplausibleRadiusWarns) {
  values(&InboxDiagnostics::tools);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(status.message, "1 tool");
  tools.push_back(shaft_tool("needle", 5.0));
  values(&InboxDiagnostics::tools);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_NE(status.message.find("tool 'needle' has a radius of 5 m"), std::string::npos)
      << status.message;
}

TEST_F(InboxDiagnosticsTest, SurfaceOfEachOrgan) {
  send_mesh(48.0, 0.0);
  auto shown = values(&InboxDiagnostics::organs);
  EXPECT_EQ(shown.at("liver, extent [m]"), "2 x 2 x 0");
  EXPECT_EQ(shown.at("liver, surface"), "not yet known");
  EXPECT_EQ(shown.at("liver, orientation"), "not yet known");
  organs.at("liver").surface()->find();
  shown = values(&InboxDiagnostics::organs);
  EXPECT_EQ(shown.at("liver, surface"), "open (4 edges)");
  EXPECT_EQ(shown.at("liver, orientation"), "none");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(status.message, "1 organ");
}

TEST_F(InboxDiagnosticsTest, ARefusedNewerMeshOfAGoodOrgan) {
  send_mesh(48.0, 0.0);
  EXPECT_FALSE(values(&InboxDiagnostics::organs).count("liver, newer mesh refused"));
  send_mesh(49.0, std::nanf(""), 2);
  auto shown = values(&InboxDiagnostics::organs);
  const std::string refusal = shown.at("liver, newer mesh refused");
  EXPECT_NE(refusal.find("nan"), std::string::npos) << refusal;
  send_mesh(49.5, 0.1F, 2);
  EXPECT_FALSE(values(&InboxDiagnostics::organs).count("liver, newer mesh refused"));
}

TEST_F(InboxDiagnosticsTest, NoToolsAreAWarning) {
  tools.clear();
  values(&InboxDiagnostics::tools);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, kNoTools);
}

TEST_F(InboxDiagnosticsTest, AgeOfEachOrgan) {
  send_mesh(48.0, 0.0);
  auto shown = values(&InboxDiagnostics::organs);
  EXPECT_EQ(std::stod(shown.at("liver, age of mesh [s]")), 2.0);
  EXPECT_EQ(shown.at("liver, faces"), "2");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  parameters.mesh_timeout_sec = 1.5;
  values(&InboxDiagnostics::organs);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
}

using namespace organ_collision;

namespace {

class QueryDiagnosticsTest : public testing::Test, protected NodeParts {
 protected:
  using Task = void (QueryDiagnostics::*)(diagnostic_updater::DiagnosticStatusWrapper&);

  std::map<std::string, std::string> values(Task task) {
    status = {};
    (diagnostics.*task)(status);
    std::map<std::string, std::string> values;
    for (const auto& pair : status.values) values[pair.key] = pair.value;
    return values;
  }

  std::vector<std::string> misspelt;
  ServiceStatistics services;
  NodeCounters counters;
  diagnostic_updater::DiagnosticStatusWrapper status;
  QueryDiagnostics diagnostics{
      {misspelt, workers.gl_version(), steps, transforms, services, counters}};
};

}  // namespace

TEST_F(QueryDiagnosticsTest, QueryTimesAndGlVersion) {
  auto shown = values(&QueryDiagnostics::queries);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(shown.at("GL version"), workers.gl_version());
  EXPECT_EQ(shown.at("queries"), "0");
  send_tip(1.0, {0.1, 0.2, 0.3});
  send_mesh(1.0, 0.0);
  evaluate();
  shown = values(&QueryDiagnostics::queries);
  EXPECT_EQ(shown.at("queries"), "1");
  EXPECT_GT(std::stod(shown.at("query time, median [us]")), 0.0);
  EXPECT_EQ(shown.at("query time, worst [us]"), shown.at("query time, 99th percentile [us]"));
}

TEST_F(QueryDiagnosticsTest, ServicesApartFromSteps) {
  services.add_query(0.003);
  services.add_motions(7);
  services.add_batch();
  auto shown = values(&QueryDiagnostics::queries);
  EXPECT_EQ(shown.at("queries"), "0");
  EXPECT_EQ(shown.at("service queries"), "1");
  EXPECT_EQ(std::stod(shown.at("service query time, median [us]")), 3000.0);
  EXPECT_EQ(shown.at("batches"), "1");
  EXPECT_EQ(shown.at("motions of batches"), "7");
}

TEST_F(QueryDiagnosticsTest, MotionThatWasNotSweptThrough) {
  for (const double time : {1.0, 2.0}) {
    send_tip(time, {0.1, 0.2, 0.3});
    send_mesh(time, 0.0);
    evaluate();
  }
  auto shown = values(&QueryDiagnostics::queries);
  EXPECT_EQ(shown.at("transforms after their step"), "0");
  EXPECT_EQ(shown.at("motion samples cut, farthest from the swept way [m]"), "0");
  send_tip(1.5, {0.1, 0.2, -0.3});
  EXPECT_EQ(values(&QueryDiagnostics::queries).at("transforms after their step"), "1");
}

TEST_F(QueryDiagnosticsTest, ShapesThatNewerOnesReplacedAndStepsWhileTfWasStarting) {
  for (const double time : {1.0, 2.0, 3.0, 4.0}) send_mesh(time, 0.0);
  counters.starting = 3;
  counters.published = 5;
  auto shown = values(&QueryDiagnostics::queries);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(shown.at("shapes due"), "4");
  EXPECT_EQ(shown.at("shapes answered"), "0");
  EXPECT_EQ(shown.at("shapes superseded by newer ones"), "2");
  EXPECT_EQ(shown.at("shapes forgotten before their step"), "0");
  EXPECT_EQ(shown.at("shapes waiting"), "2");
  EXPECT_EQ(shown.at("steps while TF was starting"), "3");
  EXPECT_EQ(shown.at("answers published"), "5");
}

TEST_F(QueryDiagnosticsTest, FailedEvaluationsAndMisspeltNamesWarn) {
  counters.failed.add("no transform", "no transform from a to b", now);
  EXPECT_EQ(values(&QueryDiagnostics::queries).at("unanswered, no transform"), "1");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  values(&QueryDiagnostics::queries);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  misspelt = {"~rates is no parameter"};
  values(&QueryDiagnostics::queries);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
}
