#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "test/node/steps/node_parts.hpp"

// How fast tissue moves, and how fast it comes near a tool: in answers between shapes and poses,
// which come at rates of their own.

using namespace organ_collision;

namespace {

constexpr double kStart = 50.0;    // [s] the time of the first messages
constexpr double kDuration = 0.7;  // [s]
constexpr double kTurns = 0.4;     // [rad/s] how fast the link turns, if it does
constexpr double kArm = 0.2;       // [m] from the axis of the link to its ball

struct Motion {
  const char* name;
  double sheet;  // [m/s] upwards
  double tool;   // [m/s] downwards
  bool is_link;  // a ball of a link turns downwards, instead of a shaft that goes downwards
};

struct Rates {
  double shapes, poses, ticks;  // [1/s]; ticks of 0: the node answers each shape and pose
};

/// A message, or a tick, that comes at `time`.
struct Event {
  double time;  // [s] since kStart
  enum { kShape, kPose, kTick } kind;
  double stamp;  // [s] since kStart
};

std::string text_of(const Motion& motion, const Rates& rates, double stamp) {
  std::ostringstream text;
  text << motion.name << ", shapes " << rates.shapes << " Hz, poses " << rates.poses
       << " Hz, ticks " << rates.ticks << " Hz, at " << stamp - kStart << " s";
  return text.str();
}

/// Messages from `begin` [s] on, whose stamps are uneven by 30 % of their period. Each is up to 4
/// ms on its way.
void add(std::vector<Event>& events, decltype(Event::kind) kind, double begin, double rate,
         std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const bool is_even = kind == Event::kTick;
  double last = 0.0;
  for (int i = 0; begin + i / rate < kDuration; ++i) {
    const double stamp = begin + (is_even ? i : i + 0.3 * share(random)) / rate;
    last = is_even ? stamp : std::max(last + 1e-6, stamp + 4e-3 * share(random));
    events.push_back({last, kind, stamp});
  }
}

/// A tool above a sheet, or in it. All that it does has a constant speed.
class MovingNode : public NodeParts {
 public:
  explicit MovingNode(const Motion& motion) : NodeParts(1, tools_of(motion)), motion_(motion) {
    parameters.tf_timeout_sec = 0.1;
    tools[0].parameters.margin = 2.0;
    tools[0].parameters.max_near = 2;
    set_point(transforms, "liver_frame", "fixed_trocar", 0.0, {0.3, 0.2, 1.0}, true);
    set_point(transforms, "liver_frame", "fixed_tip", 0.0, {0.3, 0.2, -1.0}, true);
  }

  double sheet(double time) const { return -0.4 + motion_.sheet * time; }

  void send_pose(double time) {
    const Eigen::Isometry3d T_liver_jaw =
        Eigen::Translation3d(-0.1, 0.1, 0.5) *
        Eigen::AngleAxisd(kTurns * time, Eigen::Vector3d::UnitY());
    if (motion_.is_link) {
      set_transform(transforms, "liver_frame", "arm/jaw", kStart + time, T_liver_jaw);
    } else {
      send_tip(kStart + time, {0.1, 0.2, 0.4 - motion_.tool * time});
    }
    steps.add_pose(0);
  }

  /// [m/s] How fast tool and sheet approach each other.
  double closing_speed(double time) const {
    if (!motion_.is_link) return motion_.sheet + motion_.tool;
    return motion_.sheet + kTurns * kArm * std::cos(kTurns * time);
  }

  /// The answers to an event.
  const std::vector<ContactArray>& handle(const Event& event) {
    const ros::Time before = ros::Time::now();
    ros::Time::setNow(ros::Time(kStart + event.time));
    pipeline.inbox.watch_clock();
    if (event.kind == Event::kPose) send_pose(event.stamp);
    if (event.kind == Event::kShape) send_shape(event.stamp);
    if (event.kind == Event::kTick) steps.add_tick();
    evaluate(std::chrono::nanoseconds(ros::Time::now().toNSec() - before.toNSec()));
    return published;
  }

 private:
  static std::vector<Tool> tools_of(const Motion& motion) {
    Tool hook = shaft_tool("hook", 0.01);
    if (motion.is_link) {
      hook.parameters = {};
      hook.parameters.name = "hook";
      hook.parameters.links = {"jaw"};
      hook.parameters.tf_prefix = "arm";
      hook.links = {{"jaw", {LinkPart::sphere({kArm, 0.0, 0.0}, 0.01)}}};
      hook.joints = {""};
    }
    return {hook, shaft_tool("fixed", 0.01)};
  }

  void send_shape(double time) {
    const auto z = static_cast<float>(sheet(time));
    std::exchange(has_mesh_, true) ? send_vertices(kStart + time, z) : send_mesh(kStart + time, z);
  }

  Motion motion_;
  bool has_mesh_ = false;
};

constexpr Motion kMotions[] = {{"the sheet comes, the tool rests", 0.031, 0.0, false},
                               {"the tool comes, the sheet rests", 0.0, 0.05, false},
                               {"both come", 0.031, 0.05, false},
                               {"both go", -0.031, -0.05, false},
                               {"a link turns", 0.0, 0.0, true},
                               {"a link turns and the sheet comes", 0.031, 0.0, true}};

/// All speeds are those of the motion, within 5 %.
void expect_speeds(const Motion& motion, const Rates& rates, std::mt19937& random) {
  MovingNode node(motion);
  std::vector<Event> events;
  add(events, Event::kPose, 0.0, rates.poses, random);
  add(events, Event::kShape, 0.1, rates.shapes, random);
  if (rates.ticks > 0.0) add(events, Event::kTick, 0.1, rates.ticks, random);
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.time < b.time; });
  const double velocity = motion.sheet;
  const auto is_velocity = [&](const geometry_msgs::Vector3& found) {
    return (to_eigen(found) - velocity * Eigen::Vector3d::UnitZ()).norm() <=
           0.05 * std::abs(velocity);
  };
  int measured = 0, wrong = 0, failed = 0;
  ros::Time first;
  for (const Event& event : events) {
    for (const ContactArray& answer : node.handle(event)) {
      if (first.isZero()) first = answer.mesh_stamp;
      if (answer.mesh_stamp == first) continue;
      const bool is_hook = answer.tool == "hook";
      failed += answer.status != ContactArray::OK;
      if (answer.status != ContactArray::OK) continue;
      const double expected = node.closing_speed(answer.header.stamp.toSec() - kStart);
      const double found = answer.clearance.closing_speed;
      bool is_right = !is_hook || std::abs(found - expected) <= 0.05 * std::abs(expected);
      for (const Contact& at : answer.contacts) is_right = is_right && is_velocity(at.velocity);
      for (const Contact& at : answer.near) is_right = is_right && is_velocity(at.velocity);
      EXPECT_EQ(answer.contacts.size(), is_hook ? 0u : 1u);
      EXPECT_EQ(answer.near.size(), is_hook ? 2u : 0u);
      ++measured;
      if (is_right || ++wrong > 1) continue;
      ADD_FAILURE() << text_of(motion, rates, answer.header.stamp.toSec()) << ": closing_speed is "
                    << found << ", not " << expected;
    }
  }
  EXPECT_GT(measured, 20);
  EXPECT_EQ(failed, 0);
  EXPECT_EQ(wrong, 0) << "of " << measured;
}

}  // namespace

TEST(Speed, IsThatOfTheMotionInEveryAnswerBetweenShapesAndPoses) {
  std::mt19937 random(11);
  for (const Motion& motion : kMotions) {
    for (const Rates& rates :
         {Rates{10.0, 1000.0, 500.0}, Rates{60.0, 30.0, 1000.0}, Rates{60.0, 1000.0, 30.0},
          Rates{25.0, 100.0, 0.0}, Rates{60.0, 500.0, 500.0}, Rates{10.0, 30.0, 100.0}}) {
      expect_speeds(motion, rates, random);
    }
  }
}

namespace {

/// What happens to a sheet in which a tool rests, and how fast it moves afterwards.
struct Row {
  const char* what;
  std::function<void(NodeParts&)> happens;
  double velocity;  ///< [m/s]
};

/// Sets the clock.
void pass(NodeParts& node, double time) {
  ros::Time::setNow(ros::Time(time));
  node.pipeline.inbox.watch_clock();
}

const std::vector<Row> kRows = {
    {"the first shape", [](NodeParts& node) { node.send_mesh(50.0, 0.0F); }, 0.0},
    {"the second one", [](NodeParts& node) { pass(node, 50.1), node.send_vertices(50.1, 0.1F); },
     1.0},
    {"a tick", [](NodeParts& node) { pass(node, 50.3), node.steps.add_tick(); }, 1.0},
    {"no shape for four periods", [](NodeParts& node) { pass(node, 50.55), node.steps.add_tick(); },
     1.0},
    {"nor for six", [](NodeParts& node) { pass(node, 50.7), node.steps.add_tick(); }, 0.0},
    {"a shape after this pause", [](NodeParts& node) { node.send_vertices(50.7, 0.25F); }, 0.25},
    {"a stamp that is repeated", [](NodeParts& node) { node.send_vertices(50.7, 0.3F); }, 0.0},
    {"a stamp that goes back", [](NodeParts& node) { node.send_vertices(50.6, 0.2F); }, 0.0},
    {"the next stamp", [](NodeParts& node) { pass(node, 50.8), node.send_vertices(50.8, 0.1F); },
     -0.5},
    {"other triangles", [](NodeParts& node) { node.send_mesh(50.9, 0.5F, 2); }, 0.0},
    {"the same triangles", [](NodeParts& node) { node.send_mesh(51.0, 0.4F, 2); }, -1.0},
    {"a reset",
     [](NodeParts& node) { node.pipeline.inbox.begin_history("reset"), node.steps.add_tick(); },
     0.0},
    {"a shape after it", [](NodeParts& node) { node.send_mesh(51.1, 0.1F, 2); }, 0.0},
    {"the next one", [](NodeParts& node) { node.send_mesh(51.2, 0.2F, 2); }, 1.0},
    {"a shape that came long before its transform",
     [](NodeParts& node) { node.send_mesh(51.201, 0.201F, 2), pass(node, 50.85); }, 0.0},
    {"shapes that jump",
     [](NodeParts& node) {
       node.parameters.organ_motion = false;
       node.send_mesh(51.3, 0.25F, 2);
     },
     0.0},
    {"shapes that move again, without a stamp",
     [](NodeParts& node) {
       node.parameters.organ_motion = true;
       pass(node, 51.3), node.send_mesh(0.0, 0.0F, 2), node.evaluate();
       pass(node, 51.5), node.send_mesh(0.0, 0.1F, 2);
     },
     0.5},
    {"one that waited for the one before",
     [](NodeParts& node) { pass(node, 51.5001), node.send_mesh(0.0, 0.2F, 2); }, 0.0},
    {"a clock that jumps back",
     [](NodeParts& node) { pass(node, 40.0), node.send_mesh(40.0, 0.5F, 2); }, 0.0},
};

}  // namespace

TEST(Speed, OfTissueIsThatBetweenTheLastTwoShapesUntilTheNextOneIsOverdue) {
  NodeParts node;
  set_point(node.transforms, "liver_frame", "hook_tip", 0.0, {0.1, 0.2, -1.0}, true);
  for (const Row& row : kRows) {
    SCOPED_TRACE(row.what);
    row.happens(node);
    const std::vector<ContactArray> answers = node.evaluate();
    ASSERT_EQ(answers.size(), 1U);
    ASSERT_EQ(answers[0].contacts.size(), 1U) << answers[0].message;
    const Eigen::Vector3d velocity = to_eigen(answers[0].contacts[0].velocity);
    EXPECT_LT((velocity - row.velocity * Eigen::Vector3d::UnitZ()).norm(), 1e-4)
        << velocity.transpose();
  }
}

/// The tip goes down with 0.1 m/s, by poses at 20 Hz, then no pose comes any more.
TEST(Speed, OfAToolIsThatOfItsLastPosesUntilTheNextOneIsOverdue) {
  NodeParts node;
  node.tools[0].parameters.margin = 2.0;
  node.send_mesh(0.0, 0.0F);
  const auto speed_at = [&](double time) {
    pass(node, time);
    return node.tick().at(0).clearance.closing_speed;
  };
  for (const double time : {50.0, 50.05, 50.1}) {
    pass(node, time);
    node.send_tip(time, {0.1, 0.2, 0.5 - 0.1 * (time - 50.0)});
    EXPECT_NEAR(speed_at(time + 0.02), time > 50.0 ? 0.1 : 0.0, 1e-6);
  }
  EXPECT_NEAR(speed_at(50.3), 0.1, 1e-6);
  EXPECT_EQ(speed_at(50.4), 0.0);
}
