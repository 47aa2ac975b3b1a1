#include <gtest/gtest.h>

#include <algorithm>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "test/node/steps/node_parts.hpp"

// Which steps are due, swept or static, and from where to where: sequences of messages and what is
// answered to them.

using namespace organ_collision;
using std::chrono::milliseconds;

namespace {

constexpr auto kStatic = ContactArray::STATIC;
constexpr auto kSwept = ContactArray::SWEPT;
const Eigen::Vector3d kAbove{0.1, 0.2, 0.3}, kBeneath{0.1, 0.2, -0.3};

std::vector<Tool> hook_and_needle() {
  std::vector<Tool> tools = {shaft_tool("hook", 0.01), shaft_tool("needle", 0.01)};
  tools[1].parameters.tip_pose_topic = "measured_cp";
  return tools;
}

/// A node that plays scripts. The hook's tip comes on TF; the needle's, if there is one, on a topic
/// of poses.
class ScriptedNode : public NodeParts {
 public:
  explicit ScriptedNode(bool has_needle = false)
      : NodeParts(1, has_needle ? hook_and_needle() : std::vector{shaft_tool("hook", 0.01)}) {
    set_point(transforms, "liver_frame", "needle_trocar", 0.0, {0.0, 0.0, 1.0}, true);
    clock(50.0);
  }

  /// Commands, each with its arguments, separated by semicolons. A height, of the tip or the sheet,
  /// is a number [m], or `up` or `down`.
  void play(const std::string& script) {
    std::istringstream commands(script);
    for (std::string command; std::getline(commands, command, ';');) {
      SCOPED_TRACE("'" + command + "' in: " + script);
      std::istringstream arguments(command);
      std::string name;
      arguments >> name;
      do_command(name, arguments);
      if (testing::Test::HasFatalFailure()) return;
    }
  }

  void clock(double time) {
    ros::Time::setNow(ros::Time(time));
    pipeline.inbox.watch_clock();
  }

  void take_tip(double stamp, double z, bool resting = false) {
    tf2_msgs::TFMessage message;
    const Eigen::Isometry3d T_liver_tip(Eigen::Translation3d(0.1, 0.2, z));
    message.transforms = {transform_of("liver_frame", "hook_tip", stamp, T_liver_tip)};
    pipeline.inbox.motion.take_transforms(message, "test", resting);
  }

  /// `later`: [s] since the last call, as a node that waits knows it.
  void run(double later = 0.0) {
    evaluate(std::chrono::nanoseconds(std::llround(later * 1e9)));
    all.insert(all.end(), published.begin(), published.end());
  }

  std::vector<ContactArray> all;  ///< that run() has published

 private:
  static double height(std::istream& arguments) {
    std::string word;
    arguments >> word;
    return word == "up" ? kAbove.z() : word == "down" ? kBeneath.z() : std::stod(word);
  }

  void do_command(const std::string& name, std::istream& arguments) {
    double time = 0.0;
    if (name == "tip" || name == "pose" || name == "mesh" || name == "move") arguments >> time;
    if (name == "tip") {
      take_tip(time, height(arguments));
    } else if (name == "rest") {
      take_tip(0.0, height(arguments), true);
    } else if (name == "pose") {  // Of the needle's tip, on its topic.
      pipeline.inbox.motion.take_tip(1,
                                     pose_of("liver_frame", time, {0.1, 0.2, height(arguments)}));
      run();
    } else if (name == "mesh") {  // STAMP HEIGHT [TOPOLOGY]
      const auto z = static_cast<float>(height(arguments));
      std::uint32_t topology = 1;
      arguments >> topology;
      send_mesh(time, z, arguments ? topology : 1);
    } else if (name == "move") {  // The sheet, to another height.
      send_vertices(time, static_cast<float>(height(arguments)));
    } else if (name == "run") {  // [MILLISECONDS] after the last time.
      double later = 0.0;
      arguments >> later;
      run(arguments ? 1e-3 * later : 0.0);
    } else if (name == "tick" || name == "due") {  // All tools are due, or the hook for a pose.
      name == "tick" ? steps.add_tick() : steps.add_pose(0);
      run();
    } else if (name == "glide") {  // FROM SECONDS HEIGHT PERIOD: transforms, as time goes on.
      double seconds = 0.0, period = 0.0;
      arguments >> time >> seconds;
      const double z = height(arguments);
      arguments >> period;
      for (int i = 1; i <= std::lround(seconds / period); ++i) {
        clock(time + i * period);
        take_tip(time + i * period, z);
        run(period);
      }
    } else if (name == "burst") {  // FROM COUNT: transforms of the resting tip, 1 ms apart.
      int count = 0;
      arguments >> time >> count;
      for (int i = 1; i <= count; ++i) take_tip(time + 1e-3 * i, kAbove.z());
    } else if (name == "idle") {  // SECONDS without transforms.
      double seconds = 0.0;
      arguments >> seconds;
      for (int i = 0; i < std::lround(10.0 * seconds); ++i) run(0.1);
    } else if (name == "jumps") {
      parameters.organ_motion = false;
    } else if (name == "timeout") {
      arguments >> parameters.mesh_timeout_sec;
    } else if (name == "clock") {
      arguments >> time;
      clock(time);
    } else if (name == "reset") {
      pipeline.inbox.begin_history("reset");
    } else if (name == "restart") {
      restart_sender();
    } else if (name == "drop") {
      tools.clear();
      steps.follow_histories();
    } else {
      check(name, arguments);
    }
  }

  /// Checks what the last run published.
  void check(const std::string& name, std::istream& arguments) {
    std::string text;
    std::size_t count = 0;
    if (name == "none") {
      EXPECT_TRUE(published.empty());
    } else if (name == "waits") {  // [MILLISECONDS] until a shape's time ends; else no shape waits.
      int wait = 0;
      const bool has_shape = static_cast<bool>(arguments >> wait);
      ASSERT_EQ(steps.next_deadline().has_value(), has_shape);
      EXPECT_EQ(steps.next_deadline().value_or(now + milliseconds(wait)), now + milliseconds(wait));
    } else if (name == "refused") {  // COUNT REASON
      std::getline(arguments >> count >> std::ws, text);
      EXPECT_EQ(rejected.by_reason().at(text).count, count);
    } else if (name == "shapes") {  // ANSWERED SUPERSEDED FORGOTTEN WAITING
      StepCounts expected;
      arguments >> expected.answered >> expected.superseded >> expected.forgotten >>
          expected.waiting;
      expect_shapes(expected);
    } else if (name == "touched") {  // CONTACTS in all answers about the hook.
      std::size_t contacts = 0;
      arguments >> count;
      for (const ContactArray& answer : all) {
        if (answer.tool != "hook") continue;
        EXPECT_FALSE(answer.path_incomplete) << answer.message;
        contacts += answer.contacts.size();
      }
      EXPECT_EQ(contacts, count);
    } else if (name == "answers") {  // COUNT since the start
      arguments >> count;
      EXPECT_EQ(all.size(), count);
    } else if (name == "of") {  // The stamps of the shapes, one for each answer.
      for (const ContactArray& answer : published) {
        double stamp = 0.0;
        arguments >> stamp;
        EXPECT_EQ(answer.mesh_stamp, ros::Time(stamp));
      }
      EXPECT_TRUE(arguments && !(arguments >> text));
    } else if (name == "whole") {  // The latest answer knows the whole path.
      ASSERT_FALSE(all.empty());
      EXPECT_EQ(all.back().message, "");
    } else if (name == "says" || name == "status") {  // The latest answer.
      ASSERT_FALSE(all.empty());
      std::getline(arguments >> std::ws, text);
      const std::string found = name == "says" ? all.back().message : reason_of(all.back().status);
      EXPECT_NE(found.find(text), std::string::npos) << found;
    } else {
      expect_answer(name, arguments);
    }
  }

  /// TOOL MODE CONTACTS [END [BEGIN]]: the last answer about the tool.
  void expect_answer(const std::string& tool, std::istream& arguments) {
    const auto answer = std::find_if(published.rbegin(), published.rend(),
                                     [&](const auto& answer) { return answer.tool == tool; });
    ASSERT_NE(answer, published.rend()) << tool;
    std::string mode;
    std::size_t contacts = 0;
    arguments >> mode >> contacts;
    EXPECT_EQ(answer->status, ContactArray::OK) << answer->message;
    EXPECT_EQ(answer->mode, mode == "static" ? kStatic : kSwept);
    EXPECT_EQ(answer->contacts.size(), contacts);
    EXPECT_EQ(answer->path_incomplete != 0, !answer->message.empty()) << answer->message;
    double time = 0.0;
    if (!(arguments >> time)) return;
    EXPECT_EQ(answer->header.stamp, ros::Time(time));
    if (!(arguments >> time)) return;
    EXPECT_EQ(answer->step_start, ros::Time(time));
  }

  void expect_shapes(const StepCounts& expected) const {
    const StepCounts counts = steps.counts();
    EXPECT_EQ(counts.due, counts.answered + counts.superseded + counts.forgotten + counts.waiting);
    EXPECT_EQ(counts.answered, expected.answered);
    EXPECT_EQ(counts.superseded, expected.superseded);
    EXPECT_EQ(counts.forgotten, expected.forgotten);
    EXPECT_EQ(counts.waiting, expected.waiting);
  }
};

/// Both tools are above the organ, and have been evaluated there.
const std::string kBegin = "tip 50 up; pose 50 up; mesh 50 0; run; ";

struct Case {
  std::string name;
  std::string script;
};

const std::vector<Case> kCases = {
    {"APoseIsAnsweredOnce",
     "tip 1 up; due; none; mesh 1 0; due; hook static 0 1 1; due; none; tip 1.1 down; due; "
     "hook swept 1 1.1 1; due; none; tip 1.2 up; move 1.2 0; run; hook swept 1 1.2 1.1; due; none"},
    {"AnOrganMovesThroughARestingTool",
     "tip 1 up; tip 1.1 up; mesh 1 -0.1; run; hook static 0 1 1; move 1.1 1.5; run; "
     "hook swept 2 1.1 1"},
    {"ANewTopologyRestsWhileTheToolIsSwept",
     "tip 1 up; tip 1.1 up; mesh 1 -0.1; run; mesh 1.1 1.5 2; run; hook swept 0 1.1 1; tip 1.2 2; "
     "mesh 1.2 1.5 3; run; hook swept 1 1.2 1.1"},
    {"AShapeWaitsForItsTransform",
     "tip 1 up; mesh 1.05 0; run 10; none; waits 10; tip 1.1 up; run 5; hook static 0 1.05 1.05; "
     "waits"},
    {"AStepSweepsAcrossAGapInTheTransforms",
     "tip 1 up; mesh 1 -2; run; move 1.1 0; run 19; none; run 1; status no transform; "
     "says hook_tip; tip 1.2 up; move 1.2 2; run; hook swept 2 1.2 1"},
    {"AWaitingShapeIsNotReplacedByNewerOnes",
     "mesh 1 0; run 5; move 1.1 0.1; run 5; move 1.2 0.2; tip 1 up; tip 1.3 up; run; of 1 1.2"},
    {"EachShapeIsCounted",
     "tip 1 up; mesh 1 0; shapes 0 0 0 1; run; shapes 1 0 0 0; due; tick; shapes 1 0 0 0; "
     "move 1.1 0.1; run 20; status no transform; shapes 2 0 0 0; move 1.2 0.1; move 1.3 0.1; "
     "move 1.4 0.1; shapes 2 1 0 2; clock 7; run; shapes 2 1 1 1; mesh 7 0; drop; shapes 2 1 3 0"},
    {"AnAnswerSaysHowLateTransformsWereAndHowLongTheShapeWaited",
     "tip 1 up; mesh 1.0073 0; run 20; says waited 20 ms (tf_timeout_sec); "
     "says TF from 'hook_tip' to 'liver_frame' is 7.3 ms behind the stamp 1.007300000"},
    {"ALateShapeFindsTheToolHeld",
     "tip 1 up; tip 1.5 down; mesh 1.5 -2; run; hook static 0 1.5; move 1.2 0; run; "
     "hook swept 1 1.5 1.5; of 1.2; tip 1.6 down; move 1.6 0; run; hook swept 1 1.6 1.5"},
    {"TicksSweepTheToolAndHoldTheOrgan",
     "tick; none; mesh 1 -2; tick; none; tip 1 up; run; tick; hook swept 0 1 1; tip 1.1 down; "
     "move 1.2 0; run; none; tick; hook swept 0 1.1 1; tip 1.2 down; run; hook swept 1 1.2 1.1; "
     "tick; hook swept 1 1.2 1.2"},
    {"AResetForgetsTransformsAndHistoryAndWhatWaitedIsStatic",
     "tip 1 up; mesh 1 0; run; move 1.1 0; reset; tick; none; tip 1.1 down; run; "
     "hook static 1 1.1 1.1; of 1.1"},
    {"TheFirstShapeOfARestartedSenderIsStatic",
     "tip 1 up; tip 1.1 up; mesh 1 -0.1; run; restart; mesh 1.1 1.5; run; hook static 0 1.1 1.1; "
     "tip 1.2 up; move 1.2 -0.1; run; hook swept 2 1.2 1.1; restart; tip 1.3 up; move 1.3 1.5; "
     "run; "
     "hook static 0 1.3 1.3; mesh 1.3 1.5; run; hook swept 0 1.3 1.3"},
    {"AShapeOfASenderThatIsGoneDoesNotWaitForTransforms",
     "tip 1 up; mesh 1 0; run; move 1.1 0.1; restart; mesh 1.2 0.2; shapes 1 0 1 1; tip 1.2 up; "
     "run; hook static 0 1.2 1.2; of 1.2"},
    {"TicksWaitForTheFirstStepOfARestartedSender",
     "tip 1 up; mesh 1 -0.1; run; restart; mesh 1.1 1.5; tick; none; tip 1.1 up; run; "
     "hook static 0 1.1 1.1; tick; hook swept 0 1.1 1.1"},
    {"RestingTransformsAreOfNow",
     "rest down; mesh 0 0; run; hook static 1 50 50; clock 51; move 0 0; run; hook swept 1 51 50"},

    {"AShapeAndATransformFarAheadAreRefused",
     kBegin + "tip 55 up; mesh 55 0; run; refused 1 transform; refused 1 stamp ahead; "
              "tip 50.01 down; mesh 50.01 0; run; hook swept 1"},
    {"APoseFarAheadIsRefused",
     kBegin + "pose 55 up; refused 1 pose; pose 50.01 down; needle swept 1"},
    {"ATransformVeryFarAheadDoesNotMakeTfForgetTheOthers",
     kBegin + "tip 150 up; tip 50.01 down; tick; hook swept 1"},
    {"WhatIsALittleAheadIsBelieved", kBegin + "tip 50.8 down; mesh 50.8 0; run; hook swept 1"},
    {"AStampThatWasAheadHoldsTheToolAndEachTransformBehindItIsTold",
     kBegin + "tip 50.8 up; mesh 50.8 0; run; tip 50.01 down; mesh 50.01 0; run; says 'hook_tip'; "
              "hook swept 0 50.8 50.8; move 50.02 0; run; hook swept 0 50.8; whole; tip 50.02 up; "
              "move 50.03 0; run; says 'hook_tip'; tip 50.9 down; mesh 50.9 0; run; "
              "hook swept 1 50.9 50.8; whole"},
    {"ATransformBehindAnAnsweredShapeIsToldOnce",
     kBegin + "tip 50.8 up; tip 50.01 up; mesh 50.1 0; run; hook swept 0 50.1; whole; "
              "tip 50.1 down; mesh 50.2 0; run; says 'hook_tip'; mesh 50.3 0; run; whole"},
    {"SoDoesAPoseOfATopic",
     kBegin + "pose 50.8 up; whole; pose 50.01 down; needle swept 0 50.8; says 'needle_tip'; "
              "pose 50.81 down; needle swept 1 50.81; whole"},
    {"SoDoesATick",
     "tip 50 up; mesh 50 0; run; tip 50.8 up; tick; tip 50.01 down; tick; says 'hook_tip'; tick; "
     "whole; hook swept 0 50.8"},
    {"AToolWhoseTransformsAreOnTimeIsNotHeldByAnother",
     kBegin + "tip 50.8 up; tick; tip 50.01 down; pose 50.01 down; needle swept 1 50.01; whole"},
    {"MessagesThatOvertakeEachOtherChangeNothing",
     kBegin + "tip 50.03 up; tip 50.02 up; tip 50.05 up; tip 50.04 up; tick; hook swept 0 50.05; "
              "tip 50.07 up; tip 50.06 down; tick; hook swept 1; whole"},
    {"AClockThatIsCorrectedByAFewMillisecondsChangesNothing",
     kBegin + "clock 49.985; tip 50.01 down; tick; hook swept 1"},
    {"SmallCorrectionsAddUp",
     kBegin + "clock 49.985; clock 49.975; tip 49.98 down; tick; hook static 1"},
    {"AClockThatJumpsBackForgetsTransformsAndHistory",
     kBegin + "clock 7; tick; status no transform; tip 49.99 up; refused 1 transform; tip 7 down; "
              "mesh 7 0; run; hook static 1"},
    {"WhatWasOnItsWayWhileTheClockJumpedALittleHoldsTheTool",
     "tip 50 up; mesh 50 0; run; clock 49.6; tip 50.01 up; tick; hook static 0; tip 49.61 down; "
     "tick; says 'hook_tip'; clock 50.02; tip 50.02 down; tick; hook swept 1; whole"},
    {"StampsFromBeforeTheFirstClockDoNotHoldTheTool",
     "clock 0; tip 100 up; mesh 100 0; run; hook static 0; clock 5; tip 5 down; mesh 5 0; run; "
     "hook static 1"},
    {"WhatTfForgotIsSaid",
     "tip 50 up; mesh 50 0; run; tip 51 down; clock 62; tip 62 up; mesh 62 0; run; "
     "says longer ago than transforms are kept; clock 62.1; tip 62.1 up; mesh 62.1 0; run; "
     "hook swept 0"},
    {"AStepIsTakenBeforeTfForgetsTheWay",
     "tip 50 up; mesh 50 0; run; glide 50 1 up 0.01; glide 51 1 down 0.01; glide 52 10 up 0.01; "
     "mesh 62 0; run; touched 1"},
    {"AStepIsTakenEvenIfTransformsPause",
     "tip 50 up; mesh 50 0; run; glide 50 1 down 0.01; glide 51 1 up 0.01; idle 10; clock 62; "
     "tip 62 up; mesh 62 0; run; answers 3; touched 1"},
    {"AStepThatCannotBeTakenIsNotTriedAllTheTime",
     "timeout 1; tip 50 up; mesh 50 0; run; tick; hook swept 0; glide 50 8 up 0.01; answers 3; "
     "status stale mesh"},
    {"PosesThatAreTooManyToReadAreSaid",
     "tip 50 up; mesh 50 0; run; clock 51.5; burst 50 1500; tick; says 1499 poses"},
    {"AStepIsTakenBeforePosesAreTooMany",
     "tip 50 up; mesh 50 0; run; glide 50 0.009 up 0.001; glide 50.009 0.001 down 0.001; "
     "glide 50.01 2.99 up 0.001; tick; touched 1"},
    {"AClockThatTicksRarelyChangesNothing",
     "tip 50 up; mesh 50 0; run; tip 50.01 down; mesh 50.01 0; run; hook swept 1; tip 50.02 up; "
     "mesh 50.02 0; run; hook swept 1; tip 50.03 down; mesh 50.03 0; run; hook swept 1"},
    {"AnOrganJumpsWhereItsMotionIsNotWanted",
     "jumps; tip 1 up; tip 1.1 up; mesh 1 -0.1; run; move 1.1 1.5; run; hook swept 0 1.1 1"},
};

class Steps : public testing::TestWithParam<Case> {};

TEST_P(Steps, AreWhatTheTableSays) {
  const Case& row = GetParam();
  ScriptedNode(row.script.find("pose") != std::string::npos).play(row.script);
}

INSTANTIATE_TEST_SUITE_P(Table, Steps, testing::ValuesIn(kCases),
                         [](const auto& info) { return info.param.name; });

TEST(StepScheduler, AfterTheClockJumpedBackAShapeBecomesOldAgain) {
  ScriptedNode node;
  const auto age = [&](double now) { return node.organs.at("liver").latest().age(ros::Time(now)); };
  node.play("mesh 49 0; clock 3");
  EXPECT_EQ(age(5.0), 2.0);
  node.play("clock 13; clock 12.9");
  EXPECT_EQ(age(13.0), 10.0) << "a small jump does not make it young";
}

/// Of a stream of 500 transforms a second, one is stamped 0.15 s ahead.
TEST(StepScheduler, EachTransformBehindAnAnsweredStampMakesOneStepIncomplete) {
  ScriptedNode node;
  node.play("tip 50 up; mesh 50 0; run");
  std::size_t incomplete = 0, behind = 0, after = 0;
  for (int i = 1; i < 500; ++i) {
    const double now = 50.0 + 0.002 * i;
    node.clock(now);
    node.take_tip(i == 100 ? now + 0.15 : now, kAbove.z());
    behind += i > 100 && i < 175;
    node.steps.add_tick();
    node.run();
    ASSERT_EQ(node.published.size(), 1U);
    incomplete += node.published[0].path_incomplete;
    if (now > 50.36) after += node.published[0].path_incomplete;
  }
  EXPECT_EQ(incomplete, behind);
  EXPECT_EQ(after, 0U);
  EXPECT_EQ(node.pipeline.inbox.transforms.late(), behind);
}

/// Simulated time comes in steps. A sender that knows its own time may be one step ahead, beside
/// what is allowed anyway.
TEST(StepScheduler, ASenderMayBeAheadByOneStepOfSimulatedTimeMore) {
  ScriptedNode node;
  node.play("tip 50 up; mesh 50 0; run");
  for (int step = 1; step < 10; ++step) {
    const double clock = 50.0 + 0.5 * step;
    node.clock(clock);
    for (int i = 0; i < 50; ++i) {
      node.take_tip(clock + 0.98 + 0.01 * i, kAbove.z());
      node.send_vertices(clock + 0.98 + 0.01 * i, 0.0F);
      node.run();
    }
  }
  EXPECT_TRUE(node.rejected.by_reason().empty());
  EXPECT_EQ(node.pipeline.inbox.transforms.late(), 0U);
  node.play("tip 57 up; refused 1 transform");
}

TEST(StepScheduler, AfterAChangeOfToolsAKeptToolSweepsOnAndANewOneIsStatic) {
  ScriptedNode node;
  node.play("tip 1 up; mesh 1 0; run; hook static 0 1 1; move 1.1 0; run; none");
  set_point(node.transforms, "liver_frame", "needle_tip", 1.0, kBeneath);
  node.tools = {shaft_tool("needle", 0.01), shaft_tool("hook", 0.01)};
  node.tools[0].history = 1;
  node.steps.follow_histories();
  node.play("run; needle static 1 1 1; of 1.1");  // Only the needle is due: the hook still waits.
  set_point(node.transforms, "liver_frame", "needle_tip", 1.1, kAbove);
  node.play("tick; needle swept 1 1.1 1; tip 1.1 down; run; hook swept 1 1.1 1; of 1.1");
}

TEST(StepScheduler, StepsAskForWhatTheParametersSay) {
  NodeParts node;
  node.send_tip(1.0, {0.1, 0.2, 0.03});
  node.send_mesh(1.0, 0.0);
  EXPECT_EQ(node.evaluate().at(0).clearance.state, Clearance::NOT_ASKED);
  node.tools[0].parameters.margin = 0.1;
  node.tools[0].parameters.max_near = 1;
  const ContactArray measured = node.tick().at(0);
  EXPECT_EQ(measured.clearance.state, Clearance::KNOWN);
  EXPECT_NEAR(measured.clearance.distance, 0.02, 1e-9);
  EXPECT_EQ(measured.near.size(), 1u);
  node.send_tip(1.1, kBeneath);
  EXPECT_EQ(node.tick().at(0).placement.crossings.size(), 1u);
  node.parameters.publish_placement = false;
  EXPECT_TRUE(node.tick().at(0).placement.crossings.empty());
}

/// How long time stands still in simulation, and how the clock of waits goes on.
TEST(WaitClock, FollowsSimulatedTimeAndNeverGoesBackOrStopsForEver) {
  struct Row {
    double simulated;  // [s]
    int later;         // [ms] of the wall clock since the row before
    int expected;      // [ms] since the first row
  };
  const std::vector<std::vector<Row>> sequences = {
      {{50.0, 0, 0}, {50.25, 1, 250}, {50.26, 1900, 260}, {50.26, 2000, 260}},
      {{50.0, 0, 0}, {3.0, 10, 0}, {3.5, 10, 500}},
      {{50.0, 0, 0},
       {50.0, 2000, 0},
       {50.0, 30, 30},
       {50.0, 40, 70},
       {50.1, 10, 170},
       {50.1, 1500, 170}}};
  for (const std::vector<Row>& rows : sequences) {
    WaitClock clock;
    SteadyTime wall{std::chrono::hours(3)};
    const SteadyTime start = clock.now(ros::Time(rows[0].simulated), wall);
    for (const Row& row : rows) {
      wall += milliseconds(row.later);
      EXPECT_EQ(clock.now(ros::Time(row.simulated), wall) - start, milliseconds(row.expected));
    }
    EXPECT_EQ(clock.now(std::nullopt, wall), wall);
  }
}

}  // namespace
