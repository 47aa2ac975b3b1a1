#include "ros/inbox/inbox.hpp"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>

using namespace organ_collision;

namespace {

class InboxTest : public testing::Test {
 protected:
  InboxTest() {
    ros::Time::init();
    ros::Time::setNow(ros::Time(50.0));
    inbox_.watch_clock();
  }

  static geometry_msgs::PoseStamped tip(double stamp) {
    geometry_msgs::PoseStamped pose;
    pose.header.frame_id = "base";
    pose.header.stamp = ros::Time(stamp);
    pose.pose.orientation.w = 1.0;
    return pose;
  }

  FailureLog rejected_;
  ros::CallbackQueue callbacks_;
  std::vector<std::size_t> posed_;
  Inbox inbox_{{100, 1.0},
               {{"left", "trocar", "left_tip", 0.01}, {"right", "trocar", "right_tip", 0.01}},
               {[this](std::size_t tool) { posed_.push_back(tool); }, rejected_, callbacks_}};
};

}  // namespace

TEST_F(InboxTest, OrgansAreKeptUnderTheirNames) {
  const auto mesh = boost::make_shared<OrganMesh>();
  mesh->header.frame_id = "liver_frame";
  mesh->organ = "liver";
  mesh->vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh->triangles = {0, 1, 2};
  inbox_.organ_topics().take_mesh(mesh);
  EXPECT_TRUE(inbox_.organs().organs().empty()) << "it is applied when next() is called";
  ASSERT_TRUE(inbox_.organ_topics().next());
  EXPECT_EQ(inbox_.organs().at("liver").frame(), "liver_frame");
}

TEST_F(InboxTest, AfterTheClockJumpedBackAShapeBecomesOldAgain) {
  const auto mesh = boost::make_shared<OrganMesh>();
  mesh->header.frame_id = "liver_frame";
  mesh->header.stamp = ros::Time(49.0);
  mesh->organ = "liver";
  mesh->vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh->triangles = {0, 1, 2};
  inbox_.organ_topics().take_mesh(mesh);
  ASSERT_TRUE(inbox_.organ_topics().next());
  ros::Time::setNow(ros::Time(3.0));
  EXPECT_TRUE(inbox_.watch_clock());
  EXPECT_EQ(inbox_.organs().at("liver").latest().age(ros::Time(5.0)), 2.0);
  ros::Time::setNow(ros::Time(13.0));
  EXPECT_FALSE(inbox_.watch_clock());
  ros::Time::setNow(ros::Time(12.9));
  EXPECT_TRUE(inbox_.watch_clock());
  EXPECT_EQ(inbox_.organs().at("liver").latest().age(ros::Time(13.0)), 10.0)
      << "a small jump does not make it young";
}

TEST_F(InboxTest, PosesOfTipsAreToldAndBecomeTransforms) {
  inbox_.pose_topics().take_tip(1, tip(49.0));
  EXPECT_EQ(posed_, std::vector<std::size_t>{1});
  EXPECT_TRUE(inbox_.transforms().has_heard("right_tip"));
  EXPECT_FALSE(inbox_.transforms().has_heard("left_tip"));
}

TEST_F(InboxTest, WhenTheClockJumpsBackTransformsAreForgotten) {
  inbox_.pose_topics().take_tip(1, tip(49.0));
  ros::Time::setNow(ros::Time(51.0));
  EXPECT_FALSE(inbox_.watch_clock());
  EXPECT_TRUE(inbox_.transforms().has_heard("right_tip"));
  ros::Time::setNow(ros::Time(3.0));
  EXPECT_TRUE(inbox_.watch_clock());
  EXPECT_FALSE(inbox_.transforms().has_heard("right_tip"));
  EXPECT_FALSE(inbox_.watch_clock()) << "it jumped only once";
}
