#include <random>

#include "link_motion_fixture.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "ros/steps/query_conversions.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

/// The places of wrist and jaw, and of the tip of the hook's shaft.
struct Places {
  Vector3d wrist, jaw, tip;
};

class LinkMotionQueriesTest : public LinkMotionTest {
 protected:
  void send(double time, const Places& places) {
    set_point(transforms, "liver_frame", "arm/wrist", time, places.wrist);
    set_point(transforms, "liver_frame", "arm/jaw", time, places.jaw);
    send_tip(time, places.tip);
    set_point(transforms, "liver_frame", "probe_tip", time, places.tip);
    set_point(transforms, "liver_frame", "probe_trocar", time, {0.0, 0.0, 1.0});
  }

  /// The motion from one step to the next, as a request.
  QueryCollision::Request request_of(const std::string& tool, const Places& from,
                                     const Places& to) {
    QueryCollision::Request same = request;
    same.tool = tool;
    same.link_motion.previous = {at(from.wrist), at(from.jaw)};
    same.link_motion.links = {at(to.wrist), at(to.jaw)};
    if (tool == "hook") {
      same.motion.trocar = same.motion.previous_trocar = tf2::toMsg(Vector3d(0.0, 0.0, 1.0));
      same.motion.previous_tip = tf2::toMsg(from.tip);
      same.motion.tip = tf2::toMsg(to.tip);
    }
    return same;
  }
};

QueryCollisionBatch::Request batch_of(const QueryCollision::Request& single) {
  QueryCollisionBatch::Request batch;
  batch.header = single.header;
  batch.organ = single.organ;
  batch.tool = single.tool;
  batch.mode = single.mode;
  return batch;
}

}  // namespace

TEST_F(LinkMotionQueriesTest, GiveWhatTheStepGave) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> side(-0.7, 0.7), height(-0.2, 0.2);
  const auto place = [&] {
    const double x = side(random), y = side(random), z = height(random);
    return Vector3d(x, y, z);
  };
  Places before{place(), place(), place()};
  send(1.0, before);
  EXPECT_EQ(evaluate().size(), 3u);
  std::size_t touched = 0;
  QueryCollisionBatch::Request hooks, graspers;
  std::vector<ContactArray> steps_of_hook, steps_of_grasper;
  for (int i = 1; i < 40; ++i) {
    const Places now{place(), place(), place()};
    // A binary fraction, so that no time is rounded.
    send(1.0 + i / 1024.0, now);
    send_vertices(1.0 + i / 1024.0, 0.0);
    for (const ContactArray& step : evaluate()) {
      if (step.tool == "probe") continue;
      ASSERT_EQ(step.status, ContactArray::OK) << step.message;
      const QueryCollision::Request same = request_of(step.tool, before, now);
      const ContactArray answer = services.query(same);
      ASSERT_EQ(answer.status, ContactArray::OK) << answer.message;
      EXPECT_EQ(answer.contacts, step.contacts) << step.tool << ", " << i;
      EXPECT_EQ(answer.links, step.links);
      EXPECT_EQ(answer.tool, step.tool);
      touched += step.contacts.size();
      auto& batch = step.tool == "hook" ? hooks : graspers;
      if (batch.organ.empty()) batch = batch_of(same);
      if (step.tool == "hook") batch.motions.push_back(same.motion);
      batch.link_motions.push_back(same.link_motion);
      (step.tool == "hook" ? steps_of_hook : steps_of_grasper).push_back(step);
    }
    before = now;
  }
  EXPECT_GT(touched, 50u);
  const auto expect_same = [&](const auto& batch, const std::vector<ContactArray>& published) {
    const QueryCollisionBatch::Response response = services.query_batch(batch);
    ASSERT_EQ(response.results.size(), published.size()) << response.message;
    for (std::size_t i = 0; i < published.size(); ++i) {
      EXPECT_EQ(response.results[i].contacts, published[i].contacts) << i;
      EXPECT_EQ(response.results[i].links, published[i].links);
      EXPECT_EQ(response.results[i].tool, published[i].tool);
    }
  };
  expect_same(hooks, steps_of_hook);
  expect_same(graspers, steps_of_grasper);
}

TEST_F(LinkMotionQueriesTest, AreThoseOfACollisionQuery) {
  const TriangleMesh& organ = *organs.at("liver").latest().mesh;
  CollisionQuery query;
  CollisionResult result;
  CollisionRequest direct;
  direct.organ = &organ;
  direct.mode = QueryMode::kSwept;
  direct.links = &tools[1].links;
  direct.margin = 0.5;
  direct.max_near = 4;
  std::mt19937 random(13);
  std::normal_distribution<double> number(0.0, 0.3);
  const auto pose = [&] {
    const double x = number(random), y = number(random), z = number(random), angle = number(random);
    return Eigen::Isometry3d(Eigen::Translation3d(x, y, z) *
                             Eigen::AngleAxisd(angle, Vector3d(0.6, 0.0, 0.8)));
  };
  request.margin = 0.5;
  request.max_near = 4;
  for (int i = 0; i < 50; ++i) {
    direct.path = {{0.0, {Vector3d::Zero(), Vector3d::Zero()}, {pose(), pose()}},
                   {1.0, {Vector3d::Zero(), Vector3d::Zero()}, {pose(), pose()}}};
    request.link_motion = {};
    for (int link = 0; link < 2; ++link) {
      request.link_motion.previous.push_back(tf2::toMsg(direct.path[0].links[link]));
      request.link_motion.links.push_back(tf2::toMsg(direct.path[1].links[link]));
    }
    query.evaluate(direct, result);
    const ContactArray answer = services.query(request);
    ASSERT_EQ(answer.contacts.size(), result.contacts.size()) << answer.message;
    for (std::size_t k = 0; k < result.contacts.size(); ++k) {
      EXPECT_EQ(answer.contacts[k].face, result.contacts[k].face);
      EXPECT_EQ(answer.contacts[k].link, result.contacts[k].link);
      EXPECT_NEAR(answer.contacts[k].depth, result.contacts[k].depth, 1e-12);
    }
    EXPECT_EQ(answer.near.size(), result.near.size());
    EXPECT_EQ(answer.clearance.state, static_cast<int>(result.clearance.state));
    EXPECT_NEAR(answer.clearance.distance, result.clearance.distance, 1e-12);
  }
}

TEST_F(LinkMotionQueriesTest, MoveInAnotherFrame) {
  const Eigen::Isometry3d T_liver_table =
      Eigen::Translation3d(0.5, -0.3, 0.2) *
      Eigen::AngleAxisd(0.9, Vector3d(0.2, 1.0, -0.6).normalized());
  set_transform(transforms, "liver_frame", "table", 4.0, T_liver_table);
  const ContactArray here = services.query(request);
  for (auto* poses : {&request.link_motion.previous, &request.link_motion.links}) {
    for (geometry_msgs::Pose& pose : *poses) {
      Eigen::Isometry3d T_liver_link;
      tf2::fromMsg(pose, T_liver_link);
      pose = tf2::toMsg(Eigen::Isometry3d(T_liver_table.inverse() * T_liver_link));
    }
  }
  request.header.frame_id = "table";
  const ContactArray there = services.query(request);
  EXPECT_EQ(there.header.stamp, ros::Time(4.0));
  EXPECT_EQ(there.header.frame_id, "liver_frame");
  ASSERT_EQ(here.contacts.size(), 1u);
  ASSERT_EQ(there.contacts.size(), 1u) << there.message;
  EXPECT_EQ(there.links.at(there.contacts[0].link), "jaw");
  EXPECT_NEAR(there.contacts[0].depth, here.contacts[0].depth, 1e-9);
}

TEST_F(LinkMotionQueriesTest, NeedNoPosesInTf) {
  EXPECT_EQ(services.query(request).contacts.size(), 1u);
  request.link_motion = {};
  EXPECT_EQ(services.query(request).status, ContactArray::NO_TRANSFORM);
}

TEST_F(LinkMotionQueriesTest, RefuseUnknownAndFaultyTools) {
  tools[1].fault = "grasper: parameter 'robot_description' is not set";
  QueryCollisionBatch::Request batch = batch_of(request);
  batch.link_motions = {request.link_motion};
  EXPECT_EQ(services.query(request).status, ContactArray::INVALID_TOOL);
  EXPECT_EQ(services.query_batch(batch).status, ContactArray::INVALID_TOOL);
  request.tool = batch.tool = "saw";
  EXPECT_EQ(services.query(request).status, ContactArray::UNKNOWN_TOOL);
  EXPECT_EQ(services.query_batch(batch).status, ContactArray::UNKNOWN_TOOL);
  EXPECT_NE(services.query_batch(batch).message.find("'grasper'"), std::string::npos);
}

TEST_F(LinkMotionQueriesTest, ABatchMayHaveAMotionOfZeros) {
  QueryCollisionBatch::Request batch = batch_of(request);
  batch.tool = "probe";
  batch.motions = {ToolMotion()};  // A ball in the origin, which is on the sheet.
  const QueryCollisionBatch::Response response = services.query_batch(batch);
  ASSERT_EQ(response.results.size(), 1u) << response.message;
  EXPECT_EQ(response.results[0].status, ContactArray::OK) << response.results[0].message;
  EXPECT_FALSE(response.results[0].contacts.empty());
}

TEST_F(LinkMotionQueriesTest, ABatchOfAShaftHasTheToolsRadius) {
  QueryCollisionBatch::Request batch = batch_of(request);
  batch.tool = "probe";
  ToolMotion motion = resting_shaft();
  motion.tip = motion.previous_tip = tf2::toMsg(Vector3d(0.1, 0.2, 0.015));
  batch.motions = {motion, motion, motion};
  batch.motions[1].radius = 0.02;
  batch.motions[2].radius = 0.03;
  const QueryCollisionBatch::Response response = services.query_batch(batch);
  ASSERT_EQ(response.results.size(), 3u) << response.message;
  ASSERT_EQ(response.results[0].contacts.size(), 1u) << response.results[0].message;
  EXPECT_NEAR(response.results[0].contacts[0].depth, 0.005, 1e-9);
  EXPECT_EQ(response.results[1].contacts, response.results[0].contacts);
  EXPECT_EQ(response.results[2].status, ContactArray::INVALID_REQUEST);
  EXPECT_EQ(response.results[0].tool, "probe");
}
