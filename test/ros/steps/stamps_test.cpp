#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <functional>
#include <string>
#include <vector>

#include "ros/steps/collision_pipeline.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

// Stamps, clocks and long silences: which steps are swept, which are static, and what is refused.

using namespace organ_collision;

namespace {

constexpr double kAbove = 0.3, kBelow = -0.3;  // [m] of the tip over the organ, a triangle
constexpr auto kStatic = ContactArray::STATIC;
constexpr auto kSwept = ContactArray::SWEPT;

/// A node without topics. The hook's tip comes on TF, the needle's on a pose topic.
struct Node {
  Node() {
    ros::Time::init();
    clock(50.0);
    for (const char* frame : {"hook_trocar", "needle_trocar"}) transform(frame, 0.0, 1.0, true);
  }

  void clock(double time) {
    ros::Time::setNow(ros::Time(time));
    pipeline.watch_clock();
  }

  void shape(double stamp) {
    const auto mesh = boost::make_shared<OrganMesh>();
    mesh->organ = "liver";
    mesh->header.frame_id = "liver_frame";
    mesh->header.stamp = ros::Time(stamp);
    mesh->vertices = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    mesh->triangles = {0, 1, 2};
    pipeline.inbox.intake.take_mesh(mesh);
    pipeline.apply_organ_messages(now);
    evaluate();
  }

  void transform(const std::string& frame, double stamp, double z, bool resting = false) {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    geometry_msgs::TransformStamped& transform = message.transforms[0];
    transform.header.frame_id = "liver_frame";
    transform.header.stamp = ros::Time(stamp);
    transform.child_frame_id = frame;
    transform.transform.translation.z = z;
    transform.transform.rotation.w = 1.0;
    pipeline.inbox.motion.take_transforms(message, "test", resting);
  }
  void tip(double stamp, double z) { transform("hook_tip", stamp, z); }

  void pose(double stamp, double z) {
    geometry_msgs::PoseStamped pose;
    pose.header.frame_id = "liver_frame";
    pose.header.stamp = ros::Time(stamp);
    pose.pose.position.z = z;
    pose.pose.orientation.w = 1.0;
    pipeline.inbox.motion.take_tip(1, pose);
    evaluate();
  }

  void tick() {
    pipeline.steps.add_tick();
    evaluate();
  }

  /// `later`: [s] since the last call, as a node that waits knows it.
  void evaluate(double later = 0.0) {
    now += std::chrono::nanoseconds(static_cast<std::int64_t>(later * 1e9));
    pipeline.steps.evaluate(now);
  }

  /// A second of the clock, with transforms of the hook's tip at 100 Hz, but no shape.
  void second_of_motion(double from, double z) {
    for (int i = 1; i <= 100; ++i) {
      clock(from + 0.01 * i);
      tip(from + 0.01 * i, z);
      evaluate(0.01);
    }
  }

  /// The tools' last answers, by tool.
  ContactArray hook() const { return last("hook"); }
  ContactArray needle() const { return last("needle"); }
  ContactArray last(const std::string& tool) const {
    ContactArray found;
    found.mode = 99;
    for (const ContactArray& answer : answers) {
      if (answer.tool == tool) found = answer;
    }
    return found;
  }
  std::uint64_t refused(const std::string& reason) const {
    const auto entries = rejected.by_reason();
    const auto entry = entries.find(reason);
    return entry == entries.end() ? 0 : entry->second.count;
  }

  static std::vector<Tool> two_tools() {
    std::vector<Tool> tools = {shaft_tool("hook", 0.01), shaft_tool("needle", 0.01)};
    tools[1].parameters.tip_pose_topic = "measured_cp";
    return tools;
  }
  static NodeParameters parameters_of(const std::vector<Tool>& tools) {
    NodeParameters parameters;
    for (const Tool& tool : tools) parameters.tools.push_back(tool.parameters);
    return parameters;
  }

  std::vector<Tool> tools = two_tools();
  NodeParameters parameters = parameters_of(tools);
  FailureLog rejected;
  std::vector<ContactArray> answers;
  SteadyTime now{std::chrono::hours(1)};
  CollisionPipeline pipeline{
      parameters,
      tools,
      rejected,
      {[this](const EvaluatedStep& step) { answers.push_back(*step.answer); },
       [](const OrganUpdate&) {}}};
};

void expect(const ContactArray& answer, std::uint8_t mode, std::size_t contacts) {
  EXPECT_EQ(answer.status, ContactArray::OK) << answer.message;
  EXPECT_EQ(answer.mode, mode);
  EXPECT_EQ(answer.contacts.size(), contacts);
  EXPECT_EQ(answer.path_incomplete != 0, !answer.message.empty()) << answer.message;
}

/// Both tools are above the organ, and have been evaluated there.
void begin(Node& node) {
  node.tip(50.0, kAbove);
  node.pose(50.0, kAbove);
  node.shape(50.0);
}

struct Case {
  std::string name;
  std::function<void(Node&)> play;
};

class Stamps : public testing::TestWithParam<Case> {};

const std::vector<Case> kCases = {
    {"ShapeAndTransformFarAheadAreRefused",
     [](Node& node) {
       begin(node);
       node.tip(55.0, kAbove);
       node.shape(55.0);
       EXPECT_EQ(node.refused("transform"), 1u);
       EXPECT_EQ(node.refused("stamp ahead"), 1u);
       node.tip(50.01, kBelow);
       node.shape(50.01);
       expect(node.hook(), kSwept, 1);
     }},
    {"PoseFarAheadIsRefused",
     [](Node& node) {
       begin(node);
       node.pose(55.0, kAbove);
       EXPECT_EQ(node.refused("pose"), 1u);
       node.pose(50.01, kBelow);
       expect(node.needle(), kSwept, 1);
     }},
    {"ATransformVeryFarAheadDoesNotMakeTfForgetTheOthers",
     [](Node& node) {
       begin(node);
       node.tip(150.0, kAbove);
       node.tip(50.01, kBelow);
       node.tick();
       expect(node.hook(), kSwept, 1);
     }},
    {"WhatIsALittleAheadIsBelieved",
     [](Node& node) {
       begin(node);
       node.tip(50.8, kBelow);
       node.shape(50.8);
       expect(node.hook(), kSwept, 1);
     }},
    {"AStampThatWasAheadDoesNotHoldTheToolWhenShapesComeWithEarlierOnes",
     [](Node& node) {
       begin(node);
       node.tip(50.8, kAbove);
       node.shape(50.8);
       node.tip(50.01, kBelow);
       node.shape(50.01);
       expect(node.hook(), kStatic, 1);
       node.tip(50.02, kAbove);
       node.shape(50.02);
       expect(node.hook(), kSwept, 1);
       EXPECT_EQ(node.hook().header.stamp, ros::Time(50.02));
     }},
    {"AShapeDoesNotGetAPoseBetweenAnEarlierOneAndTheOneThatWasAhead",
     [](Node& node) {
       begin(node);
       node.tip(50.8, kAbove);
       node.tip(50.01, kAbove);
       node.answers.clear();
       node.shape(50.1);
       EXPECT_EQ(node.hook().mode, 99) << "it waits for its transform";
       node.tip(50.1, kBelow);
       node.evaluate();
       expect(node.hook(), kSwept, 1);
     }},
    {"NorAPoseTopic",
     [](Node& node) {
       begin(node);
       node.pose(50.8, kAbove);
       node.pose(50.01, kBelow);
       expect(node.needle(), kStatic, 1);
       node.pose(50.02, kAbove);
       expect(node.needle(), kSwept, 1);
     }},
    {"NorATick",
     [](Node& node) {
       begin(node);
       node.tip(50.8, kAbove);
       node.tick();
       node.tip(50.01, kBelow);
       node.tick();
       expect(node.hook(), kStatic, 1);
       EXPECT_EQ(node.hook().header.stamp, ros::Time(50.01));
     }},
    {"NorDoesItIfNothingIsDueUntilTheClockGetsThere",
     [](Node& node) {
       begin(node);
       node.tip(50.8, kAbove);
       node.shape(50.8);
       node.clock(50.01);
       node.tip(50.01, kBelow);
       node.evaluate(0.2);
       expect(node.hook(), kStatic, 1);
       for (const double stamp : {50.79, 50.8, 50.9}) node.tip(stamp, kAbove);
       node.clock(50.9);
       node.tick();
       expect(node.hook(), kSwept, 1);
     }},
    {"ADisprovedStampIsNotBelievedAgainWhenTheClockReachesIt",
     [](Node& node) {
       begin(node);
       node.tip(50.9, kAbove);
       node.tip(50.5, kBelow);
       node.clock(50.91);
       node.answers.clear();
       node.shape(50.75);
       EXPECT_EQ(node.hook().mode, 99) << "it waits for its transform";
       node.tick();
       expect(node.hook(), kSwept, 1);
       EXPECT_EQ(node.hook().header.stamp, ros::Time(50.5));
     }},
    {"MessagesThatOvertakeEachOtherChangeNothing",
     [](Node& node) {
       begin(node);
       for (const double stamp : {50.03, 50.02, 50.05, 50.04}) node.tip(stamp, kAbove);
       node.tick();
       expect(node.hook(), kSwept, 0);
       EXPECT_EQ(node.hook().header.stamp, ros::Time(50.05));
       node.tip(50.045, kAbove);
       node.tip(50.06, kBelow);
       node.tick();
       expect(node.hook(), kSwept, 1);
     }},
    {"AClockThatTicksRarelyChangesNothing",
     [](Node& node) {
       begin(node);
       for (int i = 1; i <= 20; ++i) {
         node.tip(50.0 + 0.01 * i, i % 2 == 0 ? kAbove : kBelow);
         node.shape(50.0 + 0.01 * i);
         expect(node.hook(), kSwept, 1);
       }
     }},
    {"AClockThatIsCorrectedByAFewMillisecondsChangesNothing",
     [](Node& node) {
       begin(node);
       node.clock(49.985);
       node.tip(50.01, kBelow);
       node.tick();
       expect(node.hook(), kSwept, 1);
     }},
    {"SmallCorrectionsAddUp",
     [](Node& node) {
       begin(node);
       node.clock(49.985);
       node.clock(49.975);
       node.tip(49.98, kBelow);
       node.tick();
       expect(node.hook(), kStatic, 1);
     }},
    {"AClockThatJumpsBackForgetsTransformsAndHistory",
     [](Node& node) {
       begin(node);
       node.clock(7.0);
       node.answers.clear();
       node.tick();
       EXPECT_EQ(node.hook().status, ContactArray::NO_TRANSFORM);
       EXPECT_EQ(node.needle().status, ContactArray::NO_TRANSFORM);
       node.tip(49.99, kAbove);  // It was on its way.
       EXPECT_EQ(node.refused("transform"), 1u);
       node.tip(7.0, kBelow);
       node.shape(7.0);
       expect(node.hook(), kStatic, 1);
     }},
    {"AfterTheClockJumpedBackAShapeBecomesOldAgain",
     [](Node& node) {
       node.shape(49.0);
       const auto age = [&](double now) {
         return node.pipeline.inbox.organs.at("liver").latest().age(ros::Time(now));
       };
       node.clock(3.0);
       EXPECT_EQ(age(5.0), 2.0);
       node.clock(13.0);
       node.clock(12.9);
       EXPECT_EQ(age(13.0), 10.0) << "a small jump does not make it young";
     }},
    {"WhatWasOnItsWayWhileTheClockJumpedALittleIsForgotten",
     [](Node& node) {
       begin(node);
       node.clock(49.6);
       node.tip(50.01, kAbove);  // It was on its way.
       node.tick();
       expect(node.hook(), kStatic, 0);
       node.tip(49.61, kBelow);
       node.clock(49.61);
       node.tip(49.62, kBelow);
       node.tick();
       expect(node.hook(), kStatic, 1);
       node.clock(50.02);
       node.tip(50.02, kBelow);
       node.tick();
       expect(node.hook(), kSwept, 1);
       EXPECT_EQ(node.hook().contacts.at(0).fraction, 0.0) << "the tip stayed below";
     }},
    {"ResetForgetsTransformsAndHistory",
     [](Node& node) {
       begin(node);
       node.pipeline.reset();
       node.tick();
       EXPECT_EQ(node.hook().status, ContactArray::NO_TRANSFORM);
       node.tip(49.9, kBelow);
       node.tick();
       expect(node.hook(), kStatic, 1);
     }},
    {"StampsFromBeforeTheFirstClockDoNotHoldTheTool",
     [](Node& node) {
       node.clock(0.0);
       node.tip(100.0, kAbove);
       node.shape(100.0);
       expect(node.hook(), kStatic, 0);
       node.clock(5.0);
       node.tip(5.0, kBelow);
       node.shape(5.0);
       expect(node.hook(), kStatic, 1);
     }},
    {"AStepIsTakenBeforeTfForgetsTheWay",
     [](Node& node) {
       begin(node);
       node.second_of_motion(50.0, kAbove);
       node.second_of_motion(51.0, kBelow);
       for (int i = 2; i < 12; ++i) node.second_of_motion(50.0 + i, kAbove);
       node.shape(62.0);
       std::size_t contacts = 0;
       for (const ContactArray& answer : node.answers) {
         if (answer.tool != "hook") continue;
         EXPECT_FALSE(answer.path_incomplete) << answer.message;
         contacts += answer.contacts.size();
       }
       EXPECT_GE(contacts, 1u);
     }},
    {"AlsoIfTransformsPauseMeanwhile",
     [](Node& node) {
       begin(node);
       node.second_of_motion(50.0, kBelow);
       node.second_of_motion(51.0, kAbove);
       for (int i = 0; i < 100; ++i) node.evaluate(0.1);
       node.clock(62.0);
       node.tip(62.0, kAbove);
       node.shape(62.0);
       EXPECT_FALSE(node.hook().path_incomplete) << node.hook().message;
       ASSERT_EQ(node.answers.size(), 4u);
       expect(node.answers[2], kSwept, 1);
     }},
    {"AStepThatCannotBeTakenIsNotTriedAllTheTime",
     [](Node& node) {
       node.parameters.mesh_timeout_sec = 1.0;
       begin(node);
       for (int i = 0; i < 8; ++i) node.second_of_motion(50.0 + i, kAbove);
       EXPECT_EQ(node.hook().status, ContactArray::STALE_MESH);
       EXPECT_EQ(node.answers.size(), 3u);
     }},
    {"WhatTfForgotIsSaid",
     [](Node& node) {
       begin(node);
       node.tip(51.0, kBelow);
       node.clock(62.0);
       node.tip(62.0, kAbove);
       node.shape(62.0);
       EXPECT_TRUE(node.hook().path_incomplete);
       EXPECT_NE(node.hook().message.find("longer ago than transforms are kept"), std::string::npos)
           << node.hook().message;
       node.clock(62.1);
       node.tip(62.1, kAbove);
       node.shape(62.1);
       EXPECT_FALSE(node.hook().path_incomplete);
     }},
    {"PosesThatAreTooManyToReadAreSaid",
     [](Node& node) {
       begin(node);
       node.clock(51.5);
       for (int i = 1; i <= 1500; ++i) node.tip(50.0 + 1e-3 * i, kAbove);
       node.tick();
       EXPECT_TRUE(node.hook().path_incomplete);
       EXPECT_NE(node.hook().message.find("1499 poses"), std::string::npos) << node.hook().message;
     }},
    {"AStepIsTakenBeforePosesAreTooMany",
     [](Node& node) {
       begin(node);
       for (int i = 1; i <= 3000; ++i) {
         node.clock(50.0 + 1e-3 * i);
         node.tip(50.0 + 1e-3 * i, i == 10 ? kBelow : kAbove);
         node.evaluate(1e-3);
       }
       node.tick();
       std::size_t contacts = 0;
       for (const ContactArray& answer : node.answers) {
         if (answer.tool != "hook") continue;
         EXPECT_FALSE(answer.path_incomplete) << answer.message;
         contacts += answer.contacts.size();
       }
       EXPECT_EQ(contacts, 1u);
     }},
};

TEST_P(Stamps, AreBelievedOrNot) {
  Node node;
  GetParam().play(node);
}

INSTANTIATE_TEST_SUITE_P(Table, Stamps, testing::ValuesIn(kCases),
                         [](const auto& info) { return info.param.name; });

}  // namespace
