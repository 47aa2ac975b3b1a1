#include "ros/steps/collision_pipeline.hpp"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>

#include "ros/steps/inbox.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

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

using namespace organ_collision;

namespace {

class CollisionPipelineTest : public testing::Test {
 protected:
  CollisionPipelineTest() {
    ros::Time::init();
    go_to(50.0);
  }

  void go_to(double time) {
    ros::Time::setNow(ros::Time(time));
    pipeline_.watch_clock();
  }

  void send_mesh(double stamp, std::uint32_t topology = 1) {
    OrganMesh mesh;
    mesh.organ = "liver";
    mesh.header.frame_id = "liver_frame";
    mesh.header.stamp = ros::Time(stamp);
    mesh.topology = topology;
    mesh.vertices = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    mesh.triangles = {0, 1, 2};
    pipeline_.organ_topics().take_mesh(boost::make_shared<OrganMesh>(mesh));
    pipeline_.apply_organ_messages(now_);
  }

  void send_tool(double stamp) {
    tf2_msgs::TFMessage message;
    for (const auto& [frame, z] : {std::pair("hook_trocar", 1.0), std::pair("hook_tip", -0.1)}) {
      geometry_msgs::TransformStamped transform;
      transform.header.frame_id = "liver_frame";
      transform.header.stamp = ros::Time(stamp);
      transform.child_frame_id = frame;
      transform.transform.translation.z = z;
      transform.transform.rotation.w = 1.0;
      message.transforms.push_back(transform);
    }
    pipeline_.transform_topics().take(message, "test", false);
  }

  std::vector<ContactArray> evaluate() {
    answers_.clear();
    pipeline_.evaluate(now_);
    return answers_;
  }

  NodeParameters parameters_;
  std::vector<Tool> tools_ = {shaft_tool("hook", 0.01)};
  FailureLog rejected_;
  ros::CallbackQueue callbacks_;
  std::vector<ContactArray> answers_;
  std::vector<std::uint8_t> updates_;
  SteadyTime now_{std::chrono::hours(1)};
  CollisionPipeline pipeline_{
      parameters_,
      tools_,
      {[this](const EvaluatedStep& step) { answers_.push_back(*step.answer); },
       [this](const OrganUpdate& update) { updates_.push_back(update.status); }, rejected_,
       callbacks_}};
};

}  // namespace

TEST_F(CollisionPipelineTest, AnswersWithoutTopics) {
  send_mesh(50.0);
  EXPECT_EQ(updates_, std::vector<std::uint8_t>{ContactArray::OK});
  EXPECT_TRUE(evaluate().empty());
  ASSERT_TRUE(pipeline_.next_deadline());
  send_tool(50.0);
  const auto answers = evaluate();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].status, ContactArray::OK) << answers[0].message;
  EXPECT_EQ(answers[0].contacts.size(), 1u);
  EXPECT_FALSE(pipeline_.next_deadline());
}

TEST_F(CollisionPipelineTest, InspectsSurfacesAtOnceIfItIsTold) {
  send_mesh(50.0);
  EXPECT_FALSE(pipeline_.organs().at("liver").surface()->is_found());
  pipeline_.inspect_surfaces_at_once();
  send_mesh(50.0, 2);
  EXPECT_TRUE(pipeline_.organs().at("liver").surface()->is_found());
}
