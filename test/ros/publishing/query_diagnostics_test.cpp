#include "ros/publishing/query_diagnostics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "test/ros/steps/node_parts.hpp"

using namespace organ_collision;
using diagnostic_msgs::DiagnosticStatus;

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
