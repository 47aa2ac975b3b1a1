#include "ros/steps/contact_array.hpp"

#include <gtest/gtest.h>

#include "ros/interface/plain_text.hpp"

using namespace organ_collision;

namespace {

DeformableOrgan liver() {
  return {"liver", "liver_frame", TriangleMesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}, 7),
          ros::Time(10), ros::Time(12)};
}

}  // namespace

TEST(Answers, AboutAnOrganAndATool) {
  const DeformableOrgan organ = liver();
  ContactArray answer = answer_about("liver", "hook", ContactArray::SWEPT, ros::Time(11));
  set_organ(answer, organ, organ.latest());
  EXPECT_EQ(answer.organ, "liver");
  EXPECT_EQ(answer.tool, "hook");
  EXPECT_EQ(answer.mode, ContactArray::SWEPT);
  EXPECT_EQ(answer.header.stamp, ros::Time(11));
  EXPECT_EQ(answer.step_start, ros::Time(11));
  EXPECT_EQ(answer.header.frame_id, "liver_frame");
  EXPECT_EQ(answer.topology, 7u);
  EXPECT_EQ(answer.mesh_stamp, ros::Time(10));
  EXPECT_EQ(answer.links, std::vector<std::string>{""});
}

TEST(Answers, LinksOfATool) {
  ContactArray answer = answer_about("liver", "hook", ContactArray::SWEPT, ros::Time(11));
  ToolParameters tool{"hook", "hook_trocar", "hook_tip", 0.005};
  set_links(answer, tool);
  EXPECT_EQ(answer.links, std::vector<std::string>{""});
  tool.links = {"wrist", "jaw"};
  set_links(answer, tool);
  EXPECT_EQ(answer.links, (std::vector<std::string>{"", "wrist", "jaw"}));
  tool.radius = 0.0;
  set_links(answer, tool);
  EXPECT_EQ(answer.links, (std::vector<std::string>{"wrist", "jaw"}));
}

TEST(Answers, AFailureIsEmpty) {
  ContactArray answer = answer_about("liver", "hook", ContactArray::STATIC, ros::Time(11));
  answer.contacts.resize(3);
  answer.regions.resize(3);
  answer.unresolved = 1;
  answer.near.resize(2);
  answer.near_left_out = 4;
  answer.near_unresolved = 5;
  answer.clearance.state = Clearance::KNOWN;
  answer.placement.tip = ToolPlacement::INSIDE;
  answer.placement.crossings.resize(1);
  set_failure(answer, ContactArray::NO_TRANSFORM, "no transform from a to b");
  EXPECT_EQ(answer.status, ContactArray::NO_TRANSFORM);
  EXPECT_EQ(answer.message, "no transform from a to b");
  EXPECT_TRUE(answer.contacts.empty());
  EXPECT_TRUE(answer.regions.empty());
  EXPECT_EQ(answer.unresolved, 0u);
  EXPECT_TRUE(answer.near.empty());
  EXPECT_EQ(answer.near_left_out, 0u);
  EXPECT_EQ(answer.near_unresolved, 0u);
  EXPECT_EQ(answer.clearance.state, Clearance::NOT_ASKED);
  EXPECT_EQ(answer.placement.tip, ToolPlacement::UNKNOWN);
  EXPECT_TRUE(answer.placement.crossings.empty());
}

TEST(Answers, TextThatCameWithAMessageIsPlainAndShort) {
  const std::string huge(10'000'000, 'x');
  ContactArray answer = answer_about("o\n" + huge, "t\xFF" + huge, ContactArray::STATIC, {});
  EXPECT_LE(answer.organ.size(), kLongestName);
  EXPECT_EQ(answer.organ.rfind("o xxx", 0), 0u) << answer.organ;
  EXPECT_LE(answer.tool.size(), kLongestName);
  EXPECT_EQ(answer.tool.rfind("t?xxx", 0), 0u) << answer.tool;
  set_failure(answer, ContactArray::NO_TRANSFORM, "m\n" + huge);
  EXPECT_LE(answer.message.size(), kLongestMessage);
  EXPECT_EQ(answer.message.rfind("m xxx", 0), 0u) << answer.message;
}

TEST(Answers, StaleIsOlderThanTheLimit) {
  const OrganShape shape = liver().latest();
  EXPECT_FALSE(is_stale(shape, ros::Time(99), 0.0));
  EXPECT_FALSE(is_stale(shape, ros::Time(12), 2.0));
  EXPECT_TRUE(is_stale(shape, ros::Time(12.1), 2.0));
  EXPECT_FALSE(is_stale(shape, ros::Time(3), 2.0));  // The clock has jumped back.
  EXPECT_TRUE(is_stale({nullptr, ros::Time(3600), ros::Time(10)}, ros::Time(13), 2.0))
      << "a stamp of the future does not keep a shape fresh";
}

TEST(Answers, StaleSaysHowOldAndWhatIsAllowed) {
  EXPECT_EQ(stale_message("liver", liver().latest(), ros::Time(15), 2.5),
            "mesh of organ 'liver' is 5 s old; at most 2.5 s are allowed (mesh_timeout_sec)");
}
