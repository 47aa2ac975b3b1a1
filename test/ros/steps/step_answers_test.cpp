#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "test/ros/steps/node_parts.hpp"

// What steps answer: of tools with links, of fast tips, and with any number of threads.

using namespace organ_collision;

namespace {

const Eigen::Vector3d kAbove{0.1, 0.2, 0.3};
const Eigen::Vector3d kBelow{0.1, 0.2, -0.3};
const std::string kFault = "grasper: parameter 'robot_description' is not set";

/// Two tools share two links; the first one has a shaft, too. Wrist and shaft rest above the sheet
/// unless a test moves them.
class LinkToolsTest : public testing::Test, protected NodeParts {
 protected:
  LinkToolsTest() : NodeParts(1, {with_links(shaft_tool("hook", 0.01)), grasper()}) {
    set_point(transforms, "liver_frame", "hook_tip", 0.0, {0.0, 0.0, 0.7}, true);
    set_point(transforms, "liver_frame", "arm/wrist", 0.0, {-0.3, 0.2, 0.6}, true);
  }

  void send_jaw(double time, const Eigen::Vector3d& origin) {
    set_point(transforms, "liver_frame", "arm/jaw", time, origin);
  }

  /// The answer of one tool.
  static ContactArray of(const std::string& tool, const std::vector<ContactArray>& published) {
    for (const ContactArray& answer : published) {
      if (answer.tool == tool) return answer;
    }
    ADD_FAILURE() << "no answer about " << tool;
    return {};
  }
};

}  // namespace

TEST_F(LinkToolsTest, AToolWithAFaultIsNeverEvaluated) {
  tools[1].links.clear();
  tools[1].joints.clear();
  tools[1].fault = kFault;
  const auto expect_fault = [](const ContactArray& answer) {
    EXPECT_EQ(answer.tool, "grasper");
    EXPECT_EQ(answer.status, ContactArray::INVALID_TOOL);
    EXPECT_EQ(answer.message, kFault);
    EXPECT_EQ(answer.links, (std::vector<std::string>{"wrist", "jaw"}));
  };
  send_mesh(1.0, 0.0);
  auto answers = evaluate();  // The other tool waits for its jaw.
  ASSERT_EQ(answers.size(), 1u);
  expect_fault(answers[0]);
  EXPECT_EQ(answers[0].mesh_stamp, ros::Time(1.0));
  send_jaw(1.0, kAbove);
  EXPECT_EQ(of("hook", evaluate()).status, ContactArray::OK);
  answers = tick();
  ASSERT_EQ(answers.size(), 2u);
  expect_fault(of("grasper", answers));
  EXPECT_EQ(of("hook", answers).status, ContactArray::OK);
}

TEST_F(LinkToolsTest, ContactsSayWhichLink) {
  send_jaw(1.0, kAbove);
  send_mesh(1.0, 0.0);
  EXPECT_TRUE(of("grasper", evaluate()).contacts.empty());
  send_jaw(1.1, kBelow);
  send_vertices(1.1, 0.0);
  const auto published = evaluate();
  for (const ContactArray& answer : published) {
    ASSERT_EQ(answer.status, ContactArray::OK) << answer.message;
    EXPECT_EQ(answer.mode, ContactArray::SWEPT);
    ASSERT_EQ(answer.contacts.size(), 1u) << answer.tool;
    EXPECT_EQ(answer.contacts[0].face, 1u);
    EXPECT_EQ(answer.links.at(answer.contacts[0].link), "jaw");
    EXPECT_NEAR(answer.contacts[0].fraction, (0.3 - 0.01) / 0.6, 1e-7);
  }
  EXPECT_TRUE(of("grasper", tick()).contacts.empty());  // The grasper rests below the sheet.
}

TEST_F(LinkToolsTest, OneFaceMayBeTouchedByEachLink) {
  set_point(transforms, "liver_frame", "hook_tip", 0.0, {0.1, 0.2, 0.005}, true);
  set_point(transforms, "liver_frame", "arm/wrist", 0.0, {0.1, 0.3, -0.004}, true);
  send_jaw(1.0, {0.1, 0.4, 0.006});
  send_mesh(1.0, 0.0);
  const ContactArray answer = of("hook", evaluate());
  ASSERT_EQ(answer.contacts.size(), 3u);
  for (std::uint32_t link = 0; link < 3; ++link) {
    EXPECT_EQ(answer.contacts[link].face, 1u);
    EXPECT_EQ(answer.contacts[link].link, link);
  }
  EXPECT_NEAR(answer.contacts[2].depth, 0.004, 1e-7);
}

namespace {

constexpr double kRadius = 0.01;  // [m] the radius of the tool of NodeParts
constexpr double kTouch = 1e-6;   // [1] tolerance of the fraction of a step

struct Waypoint {
  double time;    // [s]
  double height;  // [m] of the tip above the sheet
};

/// A tip hovers over the sheet and, again and again, moves through it and back within 1 ms.
class FastTipTest : public testing::Test, protected NodeParts {
 protected:
  FastTipTest() { go_to(1.0, 0.05); }

  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }

  /// Sends the tip's transform at this time.
  void go_to(double time, double height) {
    way_.push_back({time, height});
    send_tip(time, {0.1, 0.2, height});
  }

  void go_through_and_back() {
    const double start = way_.back().time + uniform(2e-3, 20e-3);
    const double duration = uniform(0.2e-3, 1e-3);
    go_to(start, uniform(0.02, 0.06));
    go_to(start + uniform(0.1, 0.9) * duration, uniform(-0.02, 0.009));
    go_to(start + duration, uniform(0.02, 0.06));
  }

  /// The fraction of the step at which the tip's distance from the sheet first equals its radius,
  /// on the path that TF was given; none if it never does.
  std::optional<double> first_touch(double begin, double end) const {
    for (std::size_t i = 1; i < way_.size(); ++i) {
      const Waypoint &a = way_[i - 1], &b = way_[i];
      const double from = std::max(begin, a.time), to = std::min(end, b.time);
      if (from > to) continue;
      const double speed = (b.height - a.height) / (b.time - a.time);
      const auto height = [&](double time) { return a.height + speed * (time - a.time); };
      if (height(from) <= kRadius) return (from - begin) / (end - begin);
      if (height(to) <= kRadius) {
        return (from + (kRadius - height(from)) / speed - begin) / (end - begin);
      }
    }
    return std::nullopt;
  }

  std::mt19937 random_{7};
  std::vector<Waypoint> way_;
};

}  // namespace

TEST_F(FastTipTest, NoneOfTenThousandIsLostOrLate) {
  ros::Time::setNow(ros::Time(1000.0));
  send_mesh(1.0, 0.0);
  evaluate();
  int touches = 0, lost = 0, late = 0, invented = 0, trips = 0;
  double begin = 1.0;
  while (trips < 10'000) {
    const double end = begin + uniform(0.5e-3, 30e-3);
    for (; way_.back().time <= end; ++trips) go_through_and_back();
    send_vertices(end, 0.0);
    const auto published = evaluate();
    ASSERT_EQ(published.size(), 1u);
    ASSERT_EQ(published[0].status, ContactArray::OK) << published[0].message;
    const auto expected = first_touch(begin, end);
    const auto& contacts = published[0].contacts;
    touches += expected.has_value();
    lost += expected && contacts.empty();
    late += expected && !contacts.empty() && contacts[0].fraction > *expected + kTouch;
    invented += !contacts.empty() && (!expected || contacts[0].fraction < *expected - kTouch);
    begin = end;
    way_.erase(way_.begin(), way_.end() - std::min<std::ptrdiff_t>(way_.size(), 20));
  }
  EXPECT_GT(touches, 5'000);
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(late, 0);
  EXPECT_EQ(invented, 0);
}

namespace {

constexpr std::size_t kTools = 4;
const std::vector<std::string> kOrgans = {"gallbladder", "liver", "stomach"};

/// A node with several tools and organs: wavy sheets, one above the other.
class Node {
 public:
  explicit Node(int threads) : parts_(threads, make_tools()) {
    parts_.parameters.publish_regions = true;
    for (std::size_t tool = 1; tool < kTools; ++tool) {
      const std::string name = "tool" + std::to_string(tool);
      set_point(parts_.transforms, "liver_frame", name + "_trocar", 0.0,
                {0.3 * static_cast<double>(tool), 0.1, 1.0}, true);
    }
    parts_.tools.back().fault = "tool3: its robot is not known";
  }

  /// What is published in so many rounds, as bytes. All nodes get the same messages.
  std::string run(int rounds) {
    std::string bytes;
    for (int round = 1; round <= rounds; ++round) {
      const double time = round;
      // Sometimes a tip is late, so that a shape waits for it, and two shapes become due together.
      for (std::size_t tool = 0; tool < kTools; ++tool) {
        if (random_() % 4 > 0) send_tip(tool, time);
      }
      for (const std::string& organ : kOrgans) {
        if (random_() % 5 > 0) send_shape(organ, time);
      }
      if (random_() % 3 == 0) parts_.steps.add_pose(random_() % kTools);
      if (random_() % 3 == 0) parts_.steps.add_tick();
      for (const ContactArray& answer : parts_.evaluate(std::chrono::milliseconds(15))) {
        append(answer, bytes);
      }
    }
    return bytes;
  }

 private:
  static std::vector<Tool> make_tools() {
    std::vector<Tool> tools = {shaft_tool("hook", 0.01)};
    for (std::size_t tool = 1; tool < kTools; ++tool) {
      tools.push_back(shaft_tool("tool" + std::to_string(tool), 0.01 * static_cast<double>(tool)));
    }
    return tools;
  }

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / static_cast<double>(random_.max());
  }

  void send_tip(std::size_t tool, double time) {
    const std::string frame = tool == 0 ? "hook_tip" : "tool" + std::to_string(tool) + "_tip";
    set_point(parts_.transforms, "liver_frame", frame, time,
              {uniform(-0.8, 0.8), uniform(-0.8, 0.8), uniform(-0.5, 0.5)});
  }

  void send_shape(const std::string& organ, double time) {
    const double phase = uniform(0.0, 6.0);
    OrganMesh message = wavy_sheet(20, phase, static_cast<float>(uniform(-0.3, 0.3)));
    message.organ = organ;
    message.topology = random_() % 10 == 0 ? ++cuts_ : cuts_;
    parts_.send_mesh(time, message);
  }

  static void append(const ContactArray& answer, std::string& bytes) {
    std::vector<std::uint8_t> buffer(ros::serialization::serializationLength(answer));
    ros::serialization::OStream stream(buffer.data(), static_cast<std::uint32_t>(buffer.size()));
    ros::serialization::serialize(stream, answer);
    bytes.append(buffer.begin(), buffer.end());
  }

  NodeParts parts_;
  std::mt19937 random_{7};
  std::uint32_t cuts_ = 1;
};

}  // namespace

TEST(StepWorkers, TheAnswersDoNotDependOnTheNumberOfThreads) {
  const std::string by_one = Node(1).run(60);
  EXPECT_GT(by_one.size(), 100'000u);
  for (const int threads : {2, 3, 8}) EXPECT_TRUE(Node(threads).run(60) == by_one) << threads;
}
