#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "test/node/steps/node_parts.hpp"

// What steps answer: of tools with links, of fast tips, and with any number of threads.

using namespace organ_collision;

namespace {

/// Two tools share two links; the first one has a shaft, too. Wrist and shaft rest above the sheet.
class LinkToolsTest : public testing::Test, protected NodeParts {
 protected:
  LinkToolsTest() : NodeParts(1, {with_links(shaft_tool("hook", 0.01)), grasper()}) {
    set_point(transforms, "liver_frame", "hook_tip", 0.0, {0.0, 0.0, 0.7}, true);
    set_point(transforms, "liver_frame", "arm/wrist", 0.0, {-0.3, 0.2, 0.6}, true);
  }

  /// Sends the jaw's height and a shape of this time. Returns the answers, that of the hook first.
  std::vector<ContactArray> step(double time, double jaw) {
    set_point(transforms, "liver_frame", "arm/jaw", time, {0.1, 0.2, jaw});
    send_mesh(time, 0.0);
    return evaluate();
  }
};

}  // namespace

TEST_F(LinkToolsTest, ContactsSayWhichLink) {
  step(1.0, 0.3);
  const auto answers = step(1.1, -0.3);
  ASSERT_EQ(answers.size(), 2u);
  for (const ContactArray& answer : answers) {
    ASSERT_EQ(answer.status, ContactArray::OK) << answer.message;
    EXPECT_EQ(answer.mode, ContactArray::SWEPT);
    ASSERT_EQ(answer.contacts.size(), 1u) << answer.tool;
    EXPECT_EQ(answer.contacts[0].face, 1u);
    EXPECT_EQ(answer.links.at(answer.contacts[0].link), "jaw");
    EXPECT_NEAR(answer.contacts[0].fraction, (0.3 - 0.01) / 0.6, 1e-7);
  }
}

TEST_F(LinkToolsTest, AToolWithAFaultIsNeverEvaluated) {
  tools[1].links.clear();
  tools[1].joints.clear();
  tools[1].fault = "grasper: parameter 'robot_description' is not set";
  send_mesh(1.0, 0.0);
  const auto first = evaluate();  // The other tool waits for its jaw.
  step(1.0, 0.3);
  const auto last = tick();
  ASSERT_TRUE(first.size() == 1 && last.size() == 2);
  EXPECT_EQ(last[0].status, ContactArray::OK) << last[0].message;
  for (const ContactArray& answer : {first[0], last[1]}) {
    EXPECT_EQ(answer.tool, "grasper");
    EXPECT_EQ(answer.status, ContactArray::INVALID_TOOL);
    EXPECT_EQ(answer.message, tools[1].fault);
    EXPECT_EQ(answer.links, (std::vector<std::string>{"wrist", "jaw"}));
  }
}

namespace {}  // namespace

namespace {

constexpr std::size_t kTools = 4;

std::vector<Tool> make_tools() {
  std::vector<Tool> tools;
  for (std::size_t tool = 0; tool < kTools; ++tool) {
    tools.push_back(
        shaft_tool("tool" + std::to_string(tool), 0.01 * static_cast<double>(tool + 1)));
  }
  tools.back().fault = "tool3: its robot is not known";
  return tools;
}

/// What a node with several tools and organs publishes, as bytes. The organs are wavy sheets, one
/// above the other. All nodes get the same messages.
std::string answers_of(int threads) {
  NodeParts node(threads, make_tools());
  node.parameters.publish_regions = true;
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / static_cast<double>(random.max());
  };
  std::uint32_t cuts = 1;
  std::string bytes;
  for (int time = 1; time <= 60; ++time) {
    // Sometimes a tip is late, so that a shape waits for it, and two shapes become due together.
    for (std::size_t tool = 0; tool < kTools; ++tool) {
      const std::string& name = node.tools[tool].parameters.name;
      if (time == 1) {
        set_point(node.transforms, "liver_frame", name + "_trocar", 0.0,
                  {0.3 * static_cast<double>(tool), 0.1, 1.0}, true);
      }
      if (random() % 4 == 0) continue;
      const double x = uniform(-0.8, 0.8), y = uniform(-0.8, 0.8), z = uniform(-0.5, 0.5);
      set_point(node.transforms, "liver_frame", name + "_tip", time, {x, y, z});
    }
    for (const char* organ : {"gallbladder", "liver", "stomach"}) {
      if (random() % 5 == 0) continue;
      const double phase = uniform(0.0, 6.0), height = uniform(-0.3, 0.3);
      OrganMesh message = wavy_sheet(20, phase, static_cast<float>(height));
      message.organ = organ;
      message.topology = random() % 10 == 0 ? ++cuts : cuts;
      node.send_mesh(time, message);
    }
    if (random() % 3 == 0) node.steps.add_pose(random() % kTools);
    if (random() % 3 == 0) node.steps.add_tick();
    for (const ContactArray& answer : node.evaluate(std::chrono::milliseconds(15))) {
      const ros::SerializedMessage message = ros::serialization::serializeMessage(answer);
      bytes.append(message.buf.get(), message.buf.get() + message.num_bytes);
    }
  }
  return bytes;
}

}  // namespace

TEST(StepWorkers, TheAnswersDoNotDependOnTheNumberOfThreads) {
  const std::string by_one = answers_of(1);
  EXPECT_GT(by_one.size(), 100'000u);
  for (const int threads : {2, 3, 8}) EXPECT_TRUE(answers_of(threads) == by_one) << threads;
}
