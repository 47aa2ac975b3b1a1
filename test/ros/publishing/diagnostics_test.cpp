#include "ros/publishing/diagnostics.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <map>

#include "test/ros/steps/node_parts.hpp"

using namespace organ_collision;
using diagnostic_msgs::DiagnosticStatus;

namespace {

class DiagnosticsTest : public testing::Test, protected NodeParts {
 protected:
  using Values = std::map<std::string, std::string>;

  /// What a part of /diagnostics shows. Its summary is in `status`.
  Values of(const std::function<void()>& show) {
    status = {};
    show();
    Values values;
    for (const auto& pair : status.values) values[pair.key] = pair.value;
    return values;
  }
  Values of_tools() {
    return of([this] { show_tools(received, status); });
  }
  Values of_organs() {
    return of([this] { show_organs(received, status); });
  }
  Values of_messages() {
    return of([this] { show_messages(received, status); });
  }
  Values of_queries() {
    return of([this] { show_queries(answered, status); });
  }

  std::vector<std::string> misspelt;
  NodeCounters counters;
  diagnostic_updater::DiagnosticStatusWrapper status;
  ReceivedParts received{
      parameters.mesh_timeout_sec, tools, organs, organ_topics, counters.meshes, counters.rejected};
  AnsweredParts answered{misspelt, workers.gl_version(), steps, transforms, counters};
};

}  // namespace

TEST(EventRate, CountsSinceTheLastLook) {
  using std::chrono::milliseconds;
  const EventRate::Time start{milliseconds(7000)};
  EventRate rate(start);
  for (int i = 0; i < 30; ++i) rate.count();
  EXPECT_EQ(rate.take(start), 0.0);
  for (int i = 0; i < 30; ++i) rate.count();
  EXPECT_DOUBLE_EQ(rate.take(start + milliseconds(250)), 120.0);
  EXPECT_DOUBLE_EQ(rate.take(start + milliseconds(500)), 0.0);
}

TEST_F(DiagnosticsTest, FailuresByReasonWarnOnce) {
  EXPECT_TRUE(of_messages().count("mesh rate [1/s]"));
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  counters.rejected.add("wrong size", "7 numbers", now);
  counters.rejected.add("wrong size", "8 numbers", now);
  EXPECT_EQ(of_messages().at("rejected, wrong size"), "2");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "8 numbers");
  EXPECT_EQ(of_messages().at("rejected, wrong size"), "2");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);  // No new failure.
  counters.failed.add("no transform", "no transform from a to b", now);
  EXPECT_EQ(of_queries().at("unanswered, no transform"), "1");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  of_queries();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  misspelt = {"~rates is no parameter"};
  of_queries();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
}

TEST_F(DiagnosticsTest, WhatBecameOfOrganMessages) {
  send_mesh(48.0, 0.0);
  send_vertices(48.1, 0.1F);
  send_vertices(48.2, std::nanf(""));
  const Values shown = of_messages();
  EXPECT_EQ(shown.at("organ messages received"), "3");
  EXPECT_EQ(shown.at("organ messages applied"), "2");
  EXPECT_EQ(shown.at("organ messages refused"), "1");
  EXPECT_EQ(shown.at("organ messages that remove"), "0");
  EXPECT_EQ(shown.at("organ messages dropped behind a large mesh"), "0");
  EXPECT_EQ(shown.at("organ messages waiting"), "0");
  EXPECT_EQ(shown.at("organ messages lost before they came"), "0");
}

TEST_F(DiagnosticsTest, ToolsWithTheirFaultsAndDoubts) {
  of_tools();
  EXPECT_EQ(status.message, "1 tool");
  tools.push_back(grasper());
  const Values shown = of_tools();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(status.message, "2 tools");
  EXPECT_EQ(shown.at("hook, radius of the shaft [m]"), "0.01");
  EXPECT_FALSE(shown.count("hook, links")) << "a shaft has none";
  EXPECT_EQ(shown.at("grasper, links"), "2");
  tools.push_back(shaft_tool("needle", 5.0));
  of_tools();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_NE(status.message.find("tool 'needle' has a radius of 5 m"), std::string::npos)
      << status.message;
  tools[1].fault = "grasper: parameter 'robot_description' is not set";
  of_tools();
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_NE(status.message.find(tools[1].fault), std::string::npos) << status.message;
  tools.clear();
  of_tools();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, kNoTools);
}

TEST_F(DiagnosticsTest, OrgansWithAgeAndSurface) {
  send_mesh(48.0, 0.0);
  Values shown = of_organs();
  EXPECT_EQ(status.message, "1 organ");
  EXPECT_EQ(std::stod(shown.at("liver, age of mesh [s]")), 2.0);
  EXPECT_EQ(shown.at("liver, faces"), "2");
  EXPECT_EQ(shown.at("liver, extent [m]"), "2 x 2 x 0");
  EXPECT_EQ(shown.at("liver, surface"), "not yet known");
  EXPECT_EQ(shown.at("liver, orientation"), "not yet known");
  organs.at("liver").surface()->find();
  shown = of_organs();
  EXPECT_EQ(shown.at("liver, surface"), "open (4 edges)");
  EXPECT_EQ(shown.at("liver, orientation"), "none");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  parameters.mesh_timeout_sec = 1.5;
  of_organs();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
}

TEST_F(DiagnosticsTest, ARefusedNewerMeshOfAGoodOrgan) {
  send_mesh(48.0, 0.0);
  EXPECT_FALSE(of_organs().count("liver, newer mesh refused"));
  send_mesh(49.0, std::nanf(""), 2);
  const std::string refusal = of_organs().at("liver, newer mesh refused");
  EXPECT_NE(refusal.find("nan"), std::string::npos) << refusal;
  send_mesh(49.5, 0.1F, 2);
  EXPECT_FALSE(of_organs().count("liver, newer mesh refused"));
}

TEST_F(DiagnosticsTest, QueryTimesOfStepsAndServices) {
  Values shown = of_queries();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(shown.at("GL version"), workers.gl_version());
  EXPECT_EQ(shown.at("queries"), "0");
  send_tip(1.0, {0.1, 0.2, 0.3});
  send_mesh(1.0, 0.0);
  evaluate();
  counters.services.add_query(0.003);
  for (int i = 0; i < 7; ++i) counters.services.add_motion();
  counters.services.add_batch();
  shown = of_queries();
  EXPECT_EQ(shown.at("queries"), "1");
  EXPECT_GT(std::stod(shown.at("query time, median [us]")), 0.0);
  EXPECT_EQ(shown.at("query time, worst [us]"), shown.at("query time, 99th percentile [us]"));
  EXPECT_EQ(shown.at("service queries"), "1");
  EXPECT_EQ(std::stod(shown.at("service query time, median [us]")), 3000.0);
  EXPECT_EQ(shown.at("batches"), "1");
  EXPECT_EQ(shown.at("motions of batches"), "7");
}

TEST_F(DiagnosticsTest, MotionThatWasNotSweptThrough) {
  for (const double time : {1.0, 2.0}) {
    send_tip(time, {0.1, 0.2, 0.3});
    send_mesh(time, 0.0);
    evaluate();
  }
  const Values shown = of_queries();
  EXPECT_EQ(shown.at("transforms after their step"), "0");
  EXPECT_EQ(shown.at("motion samples cut, farthest from the swept way [m]"), "0");
  send_tip(1.5, {0.1, 0.2, -0.3});
  EXPECT_EQ(of_queries().at("transforms after their step"), "1");
}

TEST_F(DiagnosticsTest, ShapesThatNewerOnesReplacedAndStepsWhileTfWasStarting) {
  for (const double time : {1.0, 2.0, 3.0, 4.0}) send_mesh(time, 0.0);
  counters.starting = 3;
  counters.published = 5;
  const Values shown = of_queries();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(shown.at("shapes due"), "4");
  EXPECT_EQ(shown.at("shapes answered"), "0");
  EXPECT_EQ(shown.at("shapes superseded by newer ones"), "2");
  EXPECT_EQ(shown.at("shapes forgotten before their step"), "0");
  EXPECT_EQ(shown.at("shapes waiting"), "2");
  EXPECT_EQ(shown.at("steps while TF was starting"), "3");
  EXPECT_EQ(shown.at("answers published"), "5");
}
