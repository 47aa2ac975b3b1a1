// LoadWatch, and what the scheduler says of a node that falls behind.
#include <gtest/gtest.h>

#include "node/steps/step_scheduler.hpp"
#include "node_parts.hpp"

using namespace organ_collision;
using std::chrono::milliseconds;

namespace {

class LoadWatchTest : public testing::Test, protected NodeParts {
 protected:
  /// Gives a watch rounds of one step each, which begin every `period` and take `busy`, for 5 s.
  /// `merged`: how many inputs share each step with a later one.
  void work(LoadWatch& load, milliseconds period, milliseconds busy, std::uint64_t merged) {
    std::optional<ToolStep> step;
    watch = [&](const ToolStep& answered) { step = answered; };
    tick();
    watch = nullptr;
    step->query_sec = 1e-3 * static_cast<double>(busy.count());
    for (const milliseconds first = time; time - first < milliseconds(5000); time += period) {
      load.add(*step);
      load.add_round(start + time, start + time + busy, total += merged);
    }
  }

  /// In the future, so that no time that passes in a test ends a period.
  const LoadWatch::Time start = LoadWatch::Time::clock::now() + std::chrono::hours(1);
  milliseconds time{0};  ///< since `start`
  std::uint64_t total = 0;
};

}  // namespace

TEST_F(LoadWatchTest, ANodeFallsBehindIfInputsShareStepsThatTakeAllTheTime) {
  struct Case {
    int period_ms, busy_ms;
    std::uint64_t merged;
    bool is_behind;
  };
  tools[0].parameters.margin = 0.1;
  tools[0].parameters.max_near = 5;
  send_tip(1.0, {0.1, 0.2, 0.03});
  send_mesh(1.0, 0.0);
  evaluate();
  for (const Case& row :
       {Case{300, 290, 29, true}, Case{1500, 1490, 1, true}, Case{300, 290, 0, false},
        Case{300, 100, 29, false}, Case{10, 9, 1, true}, Case{10, 2, 0, false}}) {
    LoadWatch load;
    time = milliseconds(0);
    work(load, milliseconds(row.period_ms), milliseconds(row.busy_ms), row.merged);
    EXPECT_EQ(load.is_behind(start + time), row.is_behind) << row.period_ms;
    const std::optional<std::string> report = load.take_report();
    ASSERT_EQ(report.has_value(), row.is_behind) << row.period_ms;
    EXPECT_FALSE(load.take_report());
    if (!report) continue;
    for (const char* const part :
         {"tool 'hook', organ 'liver' (2 faces)", "margin 0.1", "max_near 5", "placement"}) {
      EXPECT_NE(report->find(part), std::string::npos) << *report;
    }
    EXPECT_FALSE(load.is_behind(start + time + milliseconds(2000))) << "it had nothing to do";
    work(load, milliseconds(100), milliseconds(10), 0);
    EXPECT_FALSE(load.is_behind(start + time));
  }
}

// A step of one second needs a thousand samples of its motion, and gets a hundred.
TEST_F(LoadWatchTest, AnAnswerTellsThatSamplesAreLeftOutBecauseTheNodeFallsBehind) {
  send_tip(1.0, {0.1, 0.2, 0.03});
  send_mesh(1.0, 0.0);
  evaluate();
  send_tip(2.0, {0.1, 0.25, 0.03});
  EXPECT_FALSE(tick().at(0).path_incomplete) << "the node does not fall behind";
  work(steps.load(), milliseconds(300), milliseconds(290), 29);
  send_tip(3.0, {0.1, 0.2, 0.03});
  const ContactArray answer = tick().at(0);
  EXPECT_EQ(answer.status, ContactArray::OK);
  EXPECT_TRUE(answer.path_incomplete);
  EXPECT_NE(answer.message.find("motion_samples_max"), std::string::npos) << answer.message;
}
