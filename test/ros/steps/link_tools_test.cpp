#include <gtest/gtest.h>

#include "test/ros/queries/served_node.hpp"

using namespace organ_collision;
using std::chrono::milliseconds;

namespace {

const Eigen::Vector3d kAbove{0.1, 0.2, 0.3};
const Eigen::Vector3d kBelow{0.1, 0.2, -0.3};
const std::string kFault = "grasper: parameter 'robot_description' is not set";
const std::vector<std::string> kAllLinks = {"", "wrist", "jaw"};

/// Two tools share two links; the first one has a shaft, too. Wrist and shaft rest above the sheet
/// unless a test moves them.
class LinkToolsTest : public testing::Test, protected ServedNode {
 protected:
  LinkToolsTest() {
    tools = {with_links(shaft_tool("hook", 0.01)), grasper()};
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

  ContactArray ask(const std::string& tool, std::uint8_t mode) {
    QueryCollision::Request request;
    request.header.frame_id = "liver_frame";
    request.organ = "liver";
    request.tool = tool;
    request.mode = mode;
    return services.query(request);
  }

  void break_grasper() {
    tools[1].links.clear();
    tools[1].joints.clear();
    tools[1].fault = kFault;
  }
  static void expect_fault(const ContactArray& answer) {
    EXPECT_EQ(answer.tool, "grasper");
    EXPECT_EQ(answer.status, ContactArray::INVALID_TOOL);
    EXPECT_EQ(answer.message, kFault);
    EXPECT_EQ(answer.links, (std::vector<std::string>{"wrist", "jaw"}));
    EXPECT_TRUE(answer.contacts.empty());
  }

  /// The paths of the first tool.
  std::vector<ToolPath> paths;
};

}  // namespace

TEST_F(LinkToolsTest, AnswersNameTheLinks) {
  send_jaw(1.0, kAbove);
  send_mesh(1.0, 0.0);
  const auto published = evaluate();
  ASSERT_EQ(published.size(), 2u);
  const ContactArray answer = of("hook", published);
  EXPECT_EQ(answer.status, ContactArray::OK) << answer.message;
  EXPECT_EQ(answer.links, kAllLinks);
  EXPECT_EQ(of("grasper", published).links, (std::vector<std::string>{"wrist", "jaw"}));
}

TEST_F(LinkToolsTest, StepsSweepTheLinksAcrossAGap) {
  watch = [this](const EvaluatedStep& step) {
    if (step.answer->tool == "hook") paths.push_back(step.path);
  };
  send_jaw(1.0, kAbove);
  send_mesh(1.0, 0.0);
  evaluate();
  ASSERT_EQ(paths.size(), 1u);
  ASSERT_EQ(paths[0].size(), 1u);
  ASSERT_EQ(paths[0][0].links.size(), 2u);
  EXPECT_EQ(paths[0][0].links[1].translation(), kAbove);

  send_vertices(1.1, 0.0);
  evaluate(milliseconds(20));  // The jaw has no transform.
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_TRUE(paths[1].empty());

  send_jaw(1.2, kBelow);
  send_vertices(1.2, 0.0);
  evaluate();
  ASSERT_EQ(paths.size(), 3u);
  ASSERT_EQ(paths[2].size(), 2u);
  EXPECT_EQ(paths[2][0].links[1].translation(), kAbove);
  EXPECT_EQ(paths[2][1].links[1].translation(), kBelow);
  EXPECT_EQ(paths[2][1].links[0].translation(), Eigen::Vector3d(-0.3, 0.2, 0.6));
}

TEST_F(LinkToolsTest, AMissingLinkSaysWhichJoint) {
  send_mesh(1.0, 0.0);
  const ContactArray answer = of("hook", evaluate(milliseconds(20)));
  EXPECT_EQ(answer.status, ContactArray::NO_TRANSFORM);
  EXPECT_EQ(answer.links, kAllLinks);
  EXPECT_NE(answer.message.find("jaw_joint"), std::string::npos) << answer.message;
}

TEST_F(LinkToolsTest, AToolWithAFaultIsNeverEvaluated) {
  break_grasper();
  send_mesh(1.0, 0.0);
  auto published = evaluate();  // The other tool waits for its jaw.
  ASSERT_EQ(published.size(), 1u);
  expect_fault(published[0]);
  EXPECT_EQ(published[0].mesh_stamp, ros::Time(1.0));
  send_jaw(1.0, kAbove);
  EXPECT_EQ(of("hook", evaluate()).status, ContactArray::OK);
  published = tick();
  ASSERT_EQ(published.size(), 2u);
  expect_fault(of("grasper", published));
  EXPECT_EQ(of("hook", published).status, ContactArray::OK);
  EXPECT_EQ(steps.history().last("liver", 1), nullptr);
  EXPECT_NE(steps.history().last("liver", 0), nullptr);
}

TEST_F(LinkToolsTest, QueriesOfAToolWithAFault) {
  break_grasper();
  send_mesh(1.0, 0.0);
  send_jaw(1.0, kAbove);
  for (const std::uint8_t mode :
       {ContactArray::STATIC, ContactArray::SWEPT, ContactArray::PAPER_NAIVE}) {
    expect_fault(ask("grasper", mode));
  }
  EXPECT_EQ(ask("hook", ContactArray::STATIC).status, ContactArray::OK);
}

TEST_F(LinkToolsTest, QueriesAnswerFromTheHistory) {
  send_jaw(1.0, kAbove);
  send_mesh(1.0, 0.0);
  evaluate();
  send_jaw(1.1, kBelow);
  const ContactArray swept = ask("hook", ContactArray::SWEPT);
  EXPECT_EQ(swept.status, ContactArray::OK) << swept.message;
  EXPECT_EQ(swept.links, kAllLinks);
  EXPECT_EQ(swept.step_start, ros::Time(1.0));
  EXPECT_EQ(swept.header.stamp, ros::Time(1.1));
  EXPECT_EQ(ask("hook", ContactArray::STATIC).step_start, ros::Time(1.1));
}

TEST_F(LinkToolsTest, ThePapersModesNeedAShaft) {
  send_jaw(1.0, kAbove);
  send_mesh(1.0, 0.0);
  for (const std::uint8_t mode :
       {ContactArray::PAPER_STATIC, ContactArray::PAPER_SWEPT, ContactArray::PAPER_NAIVE}) {
    const ContactArray refused = ask("grasper", mode);
    EXPECT_EQ(refused.status, ContactArray::INVALID_REQUEST);
    EXPECT_NE(refused.message.find("tool 'grasper' has no shaft"), std::string::npos)
        << refused.message;
    EXPECT_EQ(ask("hook", mode).status, ContactArray::OK) << ask("hook", mode).message;
  }
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

TEST_F(LinkToolsTest, QueriesTouchWithLinks) {
  send_jaw(1.0, kAbove);
  send_mesh(1.0, 0.0);
  evaluate();
  send_jaw(1.1, kBelow);
  for (const char* tool : {"hook", "grasper"}) {
    const ContactArray swept = ask(tool, ContactArray::SWEPT);
    ASSERT_EQ(swept.contacts.size(), 1u) << swept.message;
    EXPECT_EQ(swept.links.at(swept.contacts[0].link), "jaw");
    const ContactArray resting = ask(tool, ContactArray::STATIC);
    EXPECT_EQ(resting.status, ContactArray::OK) << resting.message;
    EXPECT_TRUE(resting.contacts.empty());
  }
}
