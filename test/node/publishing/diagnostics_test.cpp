#include "node/publishing/diagnostics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "test/node/steps/node_parts.hpp"

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
    return of([this] { show_queries(misspelt, pipeline, counters, status); });
  }

  std::vector<std::string> misspelt;
  NodeCounters counters;
  diagnostic_updater::DiagnosticStatusWrapper status;
  ReceivedParts received{
      parameters.mesh_timeout_sec, tools,           organs, organ_topics, counters.meshes,
      counters.rejected,           counters.doubted};
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

TEST_F(DiagnosticsTest, FailuresAndMisspeltNamesWarn) {
  of_messages();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  counters.rejected.add("wrong size", "8 numbers", now);
  EXPECT_EQ(of_messages().at("rejected, wrong size"), "1");
  EXPECT_EQ(status.message, "8 numbers");
  counters.failed.add("no transform", "no transform from a to b", now);
  EXPECT_EQ(of_queries().at("unanswered, no transform"), "1");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  counters.incomplete.add("path not wholly known", "a gap", now);
  EXPECT_EQ(of_queries().at("answered in part, path not wholly known"), "1");
  counters.refused.add("no mesh", "none", now);
  EXPECT_EQ(of_queries().at("refused, no mesh"), "1");
  of_queries();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  misspelt = {"~rates is no parameter"};
  of_queries();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
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

TEST_F(DiagnosticsTest, WhatStepsAndServicesCount) {
  EXPECT_EQ(of_queries().at("queries"), "0");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  for (const double time : {1.0, 2.0}) {
    send_tip(time, {0.1, 0.2, 0.3});
    send_mesh(time, 0.0);
    evaluate();
  }
  for (const double time : {3.0, 4.0, 5.0, 6.0}) send_mesh(time, 0.0);
  send_tip(1.5, {0.1, 0.2, -0.3});
  steps.add_pose(0);
  steps.add_pose(0);
  counters.published = 5;
  counters.query_times.add(0.002);
  counters.service_times.add(0.003);
  counters.motions = 7;
  counters.batches = 1;
  const Values shown = of_queries(), expected = {{"GL version", pipeline.workers.gl_version()},
                                                 {"queries", "1"},
                                                 {"query time, median [us]", "2000"},
                                                 {"query time, worst [us]", "2000"},
                                                 {"motion samples cut", "900"},
                                                 {"transforms after their step", "1"},
                                                 {"poses merged into later ones", "1"},
                                                 {"shapes due", "6"},
                                                 {"shapes answered", "2"},
                                                 {"shapes superseded by newer ones", "2"},
                                                 {"shapes forgotten before their step", "0"},
                                                 {"shapes waiting", "2"},
                                                 {"answers published", "5"},
                                                 {"service queries", "1"},
                                                 {"service query time, median [us]", "3000"},
                                                 {"batches", "1"},
                                                 {"motions of batches", "7"}};
  for (const auto& [key, value] : expected) EXPECT_EQ(shown.at(key), value) << key;
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
}

TEST(DurationStatistics, AgreesWithCountingAndForgetsTheOldest) {
  std::mt19937 random(2);
  std::lognormal_distribution<double> duration(-9.0, 1.0);
  const std::size_t capacity = DurationStatistics::kCapacity;
  for (const std::size_t size : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{99},
                                 std::size_t{100}, std::size_t{101}, capacity + 5}) {
    DurationStatistics statistics;
    EXPECT_EQ(statistics.summary().count, 0u);
    std::vector<double> values(size);
    for (double& value : values) statistics.add(value = duration(random));
    if (size > capacity) values.erase(values.begin(), values.end() - capacity);
    const DurationStatistics::Summary summary = statistics.summary();
    EXPECT_EQ(summary.count, size);
    EXPECT_EQ(summary.worst, *std::max_element(values.begin(), values.end()));
    // The smallest value that at least so many percent of all values do not exceed.
    const auto expect_percentile = [&](double found, double percent) {
      const auto share = [&](auto is_covered) {
        return 100.0 * static_cast<double>(std::count_if(values.begin(), values.end(), is_covered));
      };
      EXPECT_GE(share([&](double value) { return value <= found; }), percent * values.size());
      EXPECT_LT(share([&](double value) { return value < found; }), percent * values.size());
      EXPECT_EQ(std::count(values.begin(), values.end(), found), 1);
    };
    expect_percentile(summary.median, 50.0);
    expect_percentile(summary.percentile_99, 99.0);
  }
}
