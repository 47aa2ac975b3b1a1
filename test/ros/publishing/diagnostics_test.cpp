#include "ros/publishing/diagnostics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "test/ros/steps/node_parts.hpp"

using namespace organ_collision;
using diagnostic_msgs::DiagnosticStatus;

namespace {

class DiagnosticsTest : public testing::Test, protected NodeParts {
 protected:
  using Task = void (Diagnostics::*)(diagnostic_updater::DiagnosticStatusWrapper&);

  std::map<std::string, std::string> values(Task task) {
    status = {};
    (diagnostics.*task)(status);
    std::map<std::string, std::string> values;
    for (const auto& pair : status.values) values[pair.key] = pair.value;
    return values;
  }

  std::vector<std::string> misspelt;
  NodeCounters counters;
  diagnostic_updater::DiagnosticStatusWrapper status;
  Diagnostics diagnostics{
      {parameters, tools, misspelt, organs, contact_query, steps, transforms, counters}};
};

}  // namespace

TEST_F(DiagnosticsTest, QueryTimesAndGlVersion) {
  auto shown = values(&Diagnostics::queries);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(shown.at("GL version"), contact_query.gl_version());
  EXPECT_EQ(shown.at("queries"), "0");
  send_tip(1.0, {0.1, 0.2, 0.3});
  send_mesh(1.0, 0.0);
  evaluate();
  shown = values(&Diagnostics::queries);
  EXPECT_EQ(shown.at("queries"), "1");
  EXPECT_GT(std::stod(shown.at("query time, median [us]")), 0.0);
  EXPECT_EQ(shown.at("query time, worst [us]"), shown.at("query time, 99th percentile [us]"));
}

TEST_F(DiagnosticsTest, MotionThatWasNotSweptThrough) {
  for (const double time : {1.0, 2.0}) {
    send_tip(time, {0.1, 0.2, 0.3});
    send_mesh(time, 0.0);
    evaluate();
  }
  auto shown = values(&Diagnostics::queries);
  EXPECT_EQ(shown.at("transforms after their step"), "0");
  EXPECT_EQ(shown.at("motion samples cut, farthest from the swept way [m]"), "0");
  send_tip(1.5, {0.1, 0.2, -0.3});
  EXPECT_EQ(values(&Diagnostics::queries).at("transforms after their step"), "1");
}

TEST_F(DiagnosticsTest, ShapesThatNewerOnesReplacedAndStepsWhileTfWasStarting) {
  for (const double time : {1.0, 2.0, 3.0, 4.0}) send_mesh(time, 0.0);
  counters.starting = 3;
  auto shown = values(&Diagnostics::queries);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(shown.at("shapes superseded by newer ones"), "2");
  EXPECT_EQ(shown.at("steps while TF was starting"), "3");
}

TEST_F(DiagnosticsTest, RejectedMessagesByReason) {
  EXPECT_TRUE(values(&Diagnostics::messages).count("mesh rate [1/s]"));
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  counters.rejected.add("wrong size", "7 numbers", now);
  counters.rejected.add("wrong size", "8 numbers", now);
  EXPECT_EQ(values(&Diagnostics::messages).at("rejected, wrong size"), "2");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "8 numbers");
  EXPECT_EQ(values(&Diagnostics::messages).at("rejected, wrong size"), "2");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);  // No new failure.
}

TEST_F(DiagnosticsTest, FailedEvaluationsAndMisspeltNamesWarn) {
  counters.failed.add("no transform", "no transform from a to b", now);
  EXPECT_EQ(values(&Diagnostics::queries).at("unanswered, no transform"), "1");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  values(&Diagnostics::queries);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  misspelt = {"~rates is no parameter"};
  values(&Diagnostics::queries);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
}

TEST_F(DiagnosticsTest, AToolWithAFaultIsAnError) {
  tools.push_back(grasper());
  auto shown = values(&Diagnostics::tools);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(status.message, "2 tools");
  EXPECT_EQ(shown.at("hook, radius of the shaft [m]"), "0.01");
  EXPECT_FALSE(shown.count("hook, links")) << "a shaft has none";
  EXPECT_EQ(shown.at("grasper, links"), "2");
  tools.push_back(shaft_tool("needle", 0.001));
  tools[1].fault = "grasper: parameter 'robot_description' is not set";
  values(&Diagnostics::tools);
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_NE(status.message.find(tools[1].fault), std::string::npos) << status.message;
}

TEST_F(DiagnosticsTest, OneToolIsCountedAndAnImplausibleRadiusWarns) {
  values(&Diagnostics::tools);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(status.message, "1 tool");
  tools.push_back(shaft_tool("needle", 5.0));
  values(&Diagnostics::tools);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_NE(status.message.find("tool 'needle' has a radius of 5 m"), std::string::npos)
      << status.message;
}

TEST_F(DiagnosticsTest, SurfaceOfEachOrgan) {
  send_mesh(48.0, 0.0);
  auto shown = values(&Diagnostics::organs);
  EXPECT_EQ(shown.at("liver, extent [m]"), "2 x 2 x 0");
  EXPECT_EQ(shown.at("liver, surface"), "not yet known");
  EXPECT_EQ(shown.at("liver, orientation"), "not yet known");
  organs.at("liver").surface()->find();
  shown = values(&Diagnostics::organs);
  EXPECT_EQ(shown.at("liver, surface"), "open (4 edges)");
  EXPECT_EQ(shown.at("liver, orientation"), "none");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(status.message, "1 organ");
}

TEST_F(DiagnosticsTest, ARefusedNewerMeshOfAGoodOrgan) {
  send_mesh(48.0, 0.0);
  EXPECT_FALSE(values(&Diagnostics::organs).count("liver, newer mesh refused"));
  send_mesh(49.0, std::nanf(""), 2);
  auto shown = values(&Diagnostics::organs);
  const std::string refusal = shown.at("liver, newer mesh refused");
  EXPECT_NE(refusal.find("nan"), std::string::npos) << refusal;
  send_mesh(49.5, 0.1F, 2);
  EXPECT_FALSE(values(&Diagnostics::organs).count("liver, newer mesh refused"));
}

TEST_F(DiagnosticsTest, NoToolsAreAWarning) {
  tools.clear();
  values(&Diagnostics::tools);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, kNoTools);
}

TEST_F(DiagnosticsTest, AgeOfEachOrgan) {
  send_mesh(48.0, 0.0);
  auto shown = values(&Diagnostics::organs);
  EXPECT_EQ(std::stod(shown.at("liver, age of mesh [s]")), 2.0);
  EXPECT_EQ(shown.at("liver, faces"), "2");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  parameters.mesh_timeout_sec = 1.5;
  values(&Diagnostics::organs);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
}
