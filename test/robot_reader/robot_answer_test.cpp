#include "robot_reader/robot_answer.hpp"

#include <gtest/gtest.h>

#include <new>

#include "ros/tools/robot_reply.hpp"
#include "test/ros/tools/tool_files.hpp"

namespace organ_collision {
namespace {

using Urdf = std::function<std::string()>;

/// The answer, as the node reads it.
RobotReply ask(const Urdf& urdf, const std::vector<std::string>& links) {
  std::string bytes;
  answer_with_links(urdf, links, [&](const std::string& record) { bytes += record; });
  return parse_reply(bytes);
}

std::string gripper() { return tool_text("gripper.urdf"); }

TEST(RobotAnswer, HasTheLinksInTheOrderOfTheirNames) {
  const RobotReply reply = ask(gripper, {"shaft", "jaw", "shaft"});
  EXPECT_FALSE(reply.refusal);
  ASSERT_TRUE(reply.links);
  ASSERT_EQ(reply.links->size(), 3U);
  EXPECT_EQ((*reply.links)[0].shapes.size(), 2U);
  EXPECT_EQ((*reply.links)[2].shapes.size(), 2U);
}

TEST(RobotAnswer, NamesAMeshBeforeItIsRead) {
  std::vector<std::string> records;
  const auto urdf = [] {
    return "<robot name='r'><link name='tip'><collision><geometry><mesh filename='" +
           tool_file("jaw.obj") + "'/></geometry></collision></link></robot>";
  };
  answer_with_links(urdf, {"tip"}, [&](const std::string& record) { records.push_back(record); });
  ASSERT_EQ(records.size(), 2U);
  const RobotReply cut_off = parse_reply(records[0]);
  expect_words(cut_off.reading, {"tip", "jaw.obj"});
  EXPECT_FALSE(cut_off.refusal);
  EXPECT_FALSE(cut_off.links);
}

TEST(RobotAnswer, IsARefusalIfALinkIsMissing) {
  const RobotReply reply = ask(gripper, {"shaft", "nobody"});
  ASSERT_TRUE(reply.refusal);
  expect_words(*reply.refusal, {"nobody"});
  EXPECT_FALSE(reply.links);
}

TEST(RobotAnswer, IsARefusalIfTheUrdfCannotBeRead) {
  const Urdf missing = []() -> std::string { throw ToolError("cannot read 'x.urdf'"); };
  EXPECT_EQ(ask(missing, {"tip"}).refusal, "cannot read 'x.urdf'");
  const Urdf large = []() -> std::string { throw std::bad_alloc(); };
  EXPECT_EQ(ask(large, {"tip"}).refusal, "there is not enough memory to read it");
}

}  // namespace
}  // namespace organ_collision
