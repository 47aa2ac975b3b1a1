#include "node/queries/query_services.hpp"

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <tf2_eigen/tf2_eigen.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "common/messages/conversions.hpp"
#include "query_fixtures.hpp"
#include "test/node/tools/tool_files.hpp"

using namespace organ_collision;
using Eigen::Vector3d;
using ros::serialization::serializationLength;
using Batch = QueryCollisionBatch::Request;
using Single = QueryCollision::Request;

namespace {

const Vector3d kAboveOrgan{0.1, 0.2, 0.3};
const Vector3d kBelow{0.1, 0.2, -0.3};
const double kNan = std::nan(""), kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint8_t kInvalid = ContactArray::INVALID_REQUEST;

/// A motion that crosses the sheet at height 0, in the organ's frame.
ToolMotion through() {
  ToolMotion motion;
  motion.previous_trocar = motion.trocar = tf2::toMsg(Vector3d(0.0, 0.0, 1.0));
  motion.previous_tip = tf2::toMsg(kAboveOrgan);
  motion.tip = tf2::toMsg(kBelow);
  motion.radius = 0.01;
  return motion;
}

/// A shaft that rests above the sheet, as the motion of a tool.
ToolMotion resting_shaft() {
  ToolMotion motion = through();
  motion.tip = motion.previous_tip = tf2::toMsg(kAboveOrgan);
  motion.radius = 0.0;
  return motion;
}

geometry_msgs::Pose at(const Vector3d& position) {
  geometry_msgs::Pose pose;
  pose.position = tf2::toMsg(position);
  pose.orientation.w = 1.0;
  return pose;
}

/// The wrist rests above the sheet, and the jaw goes through it.
LinkMotion jaw_goes_down() {
  LinkMotion motion;
  motion.previous = {at({-0.3, 0.2, 0.6}), at({0.1, 0.2, 0.3})};
  motion.links = {at({-0.3, 0.2, 0.6}), at({0.1, 0.2, -0.3})};
  return motion;
}

/// The services of a node with one organ, "liver", and a request of a swept query that touches it.
class QueryServicesTest : public testing::Test, protected ServedNode {
 protected:
  explicit QueryServicesTest(const std::vector<Tool>& list = {shaft_tool("hook", 0.01)})
      : ServedNode(2, list) {
    request.header.frame_id = "liver_frame";
    request.organ = "liver";
    request.motion = through();
    request.mode = ContactArray::SWEPT;
    send_mesh(1.0, 0.0);
  }

  void expect_refused(std::uint8_t status, const std::vector<std::string>& words) {
    const ContactArray answer = services.query(request);
    EXPECT_EQ(answer.status, status) << answer.message;
    EXPECT_TRUE(answer.contacts.empty());
    expect_words(answer.message, words);
  }

  /// A batch that asks what the request asks, of these motions.
  Batch batch_of(const std::vector<ToolMotion>& motions) const {
    Batch batch;
    batch.header = request.header;
    batch.organ = request.organ;
    batch.tool = request.tool;
    batch.mode = request.mode;
    batch.margin = request.margin;
    batch.clearance = request.clearance;
    batch.placement = request.placement;
    batch.motions = motions;
    return batch;
  }

  /// The organ becomes a closed surface. Its surface is not inspected yet.
  void send_tetrahedron() {
    OrganMesh mesh;
    mesh.topology = 2;
    mesh.vertices = {-1, -1, -1, 2, -1, -1, -1, 2, -1, -1, -1, 2};
    mesh.triangles = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    send_mesh(1.1, mesh);
  }

  void expect_refused(const Batch& batch, std::uint8_t status, const std::string& word) {
    const QueryCollisionBatch::Response response = services.query_batch(batch);
    EXPECT_EQ(response.status, status) << response.message;
    expect_words(response.message, {word});
    EXPECT_TRUE(response.results.empty());
  }

  Single request;
};

/// A node with a sheet of 800 faces.
struct BatchNode : ServedNode {
  explicit BatchNode(int threads) : ServedNode(threads) {
    send_mesh(1.0, wavy_sheet(20, 0.5, 0.0F));
  }
};

class BatchTest : public testing::Test {
 protected:
  /// Shafts that go from heights in [0.05, 0.3] to heights in [low, 0.3].
  void add_random_shafts(std::size_t count, double low) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.8, 0.8), from(0.05, 0.3), to(low, 0.3);
    for (std::size_t i = 0; i < count; ++i) {
      ToolMotion& motion = batch.motions.emplace_back();
      const auto point = [&](double z) {
        const double x = place(random), y = place(random);
        return tf2::toMsg(Vector3d(x, y, z));
      };
      motion.trocar = motion.previous_trocar = point(1.0);
      motion.previous_tip = point(from(random));
      motion.tip = point(to(random));
      motion.radius = i % 7 == 3 ? 0.0 : 0.01;  // Some are illegal.
    }
  }
  BatchTest() {
    batch.header.frame_id = "liver_frame";
    batch.organ = "liver";
    batch.mode = ContactArray::SWEPT;
    for (const int threads : {1, 2, 5}) nodes.push_back(std::make_unique<BatchNode>(threads));
  }

  /// The response, which must be the same for each number of threads.
  QueryCollisionBatch::Response answer(int max_batch_bytes = 256 << 20) {
    for (const auto& node : nodes) node->parameters.max_batch_bytes = max_batch_bytes;
    const QueryCollisionBatch::Response response = nodes[0]->services.query_batch(batch);
    EXPECT_EQ(nodes[1]->services.query_batch(batch), response);
    EXPECT_EQ(nodes[2]->services.query_batch(batch), response);
    return response;
  }

  std::vector<std::unique_ptr<BatchNode>> nodes;  ///< with 1, 2 and 5 threads
  Batch batch;
};

/// A node with a hook that has a shaft and two links, a grasper that has only the links, and a
/// probe that has only a shaft. See with_links() and NodeParts.
class LinkQueriesTest : public QueryServicesTest {
 protected:
  LinkQueriesTest()
      : QueryServicesTest(
            {with_links(shaft_tool("hook", 0.01)), grasper(), shaft_tool("probe", 0.02)}) {
    request.tool = "grasper";
    request.motion = {};
    request.link_motion = jaw_goes_down();
  }
};

}  // namespace

TEST_F(QueryServicesTest, SweptAndStatic) {
  ContactArray answer = services.query(request);
  EXPECT_EQ(answer.status, ContactArray::OK) << answer.message;
  ASSERT_EQ(answer.contacts.size(), 1u);
  EXPECT_EQ(answer.contacts[0].face, 1u);
  EXPECT_EQ(answer.header.frame_id, "liver_frame");
  EXPECT_EQ(answer.mesh_stamp, ros::Time(1.0));
  EXPECT_TRUE(answer.regions.empty());
  request.mode = ContactArray::STATIC;
  request.motion.tip = tf2::toMsg(kAboveOrgan);
  request.motion.previous_tip = tf2::toMsg(kBelow);
  answer = services.query(request);
  EXPECT_EQ(answer.status, ContactArray::OK);
  EXPECT_TRUE(answer.contacts.empty());
}

TEST_F(QueryServicesTest, OrganRestsOnRequestAndInStaticQueries) {
  send_vertices(1.1, 2.0f);
  request.motion.previous_tip = request.motion.tip = tf2::toMsg(kAboveOrgan);
  EXPECT_EQ(services.query(request).contacts.size(), 2u);
  request.organ_rests = true;
  EXPECT_TRUE(services.query(request).contacts.empty());
  request.organ_rests = false;
  request.mode = ContactArray::STATIC;
  EXPECT_TRUE(services.query(request).contacts.empty());
}

TEST_F(QueryServicesTest, TellHowFastTissueMovesAndComesNearATool) {
  send_vertices(1.1, 0.05F);
  const auto velocity = [&] { return services.query(request).contacts.at(0).velocity.z; };
  request.clearance = true;
  EXPECT_NEAR(velocity(), 0.5, 1e-6);
  EXPECT_EQ(services.query(request).clearance.closing_speed, 0.0);  // The motion has no duration.
  request.organ_rests = true;
  EXPECT_EQ(velocity(), 0.0);
  request.organ_rests = false;
  request.mode = ContactArray::STATIC;
  EXPECT_NEAR(velocity(), 0.5, 1e-6);
  for (const double time : {1.0, 1.05, 1.1}) send_tip(time, {0.1, 0.2, 0.4 - 0.2 * (time - 1.0)});
  evaluate();
  request.tool = "hook";
  request.motion = {};
  EXPECT_EQ(services.query(request).clearance.closing_speed, 0.0);
  request.mode = ContactArray::SWEPT;
  EXPECT_NEAR(services.query(request).clearance.closing_speed, 0.7, 1e-6);
  request.organ_rests = true;
  EXPECT_NEAR(services.query(request).clearance.closing_speed, 0.2, 1e-6);
}

// Shapes come regularly, late, without stamps, with gaps, from a restarted sender, or after a
// reset.
TEST_F(QueryServicesTest, AQuestionHasTheVelocityOfAStepOfTheSameMoment) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  request.motion = {};
  request.tool = "hook";
  request.mode = ContactArray::SWEPT;
  double time = 60.0;
  std::size_t moving = 0, resting = 0;
  for (int run = 0; run < 200; ++run) {
    const double period = std::pow(10.0, -2.0 + 1.5 * share(random));
    const double kind = share(random);
    const auto pass = [&](double seconds) {
      ros::Time::setNow(ros::Time(time += seconds));
      pipeline.inbox.watch_clock();
      send_tip(time, {0.1, 0.2, -1.0});
    };
    if (kind < 0.1) restart_sender();
    if (kind > 0.9) pipeline.inbox.begin_history("reset");
    for (int i = 0; i < 12; ++i) {
      const double lag = kind < 0.3 ? 3.0 * period * share(random) : 0.0;
      pass(i % 5 == 4 ? 8.0 * period * share(random) : period * (0.5 + share(random)));
      if (share(random) < 0.7) {
        const auto height = static_cast<float>(0.1 * share(random));
        send_vertices(kind > 0.8 ? 0.0 : time - lag, height);
      }
      for (int part = 0; part < 3; ++part) {
        if (part > 0) pass(3.0 * period * share(random));
        steps.add_tick();
        const std::vector<ContactArray> answers = evaluate();
        if (answers.empty() || answers.back().status != ContactArray::OK) continue;
        const ContactArray asked = services.query(request);
        ASSERT_EQ(asked.status, ContactArray::OK) << asked.message;
        ASSERT_EQ(asked.contacts.size(), answers.back().contacts.size());
        for (std::size_t k = 0; k < asked.contacts.size(); ++k) {
          const double velocity = answers.back().contacts[k].velocity.z;
          ASSERT_EQ(asked.contacts[k].velocity.z, velocity) << "run " << run << ", at " << time;
          ++(velocity == 0.0 ? resting : moving);
        }
      }
    }
  }
  EXPECT_GT(moving, 500U);
  EXPECT_GT(resting, 500U);
}

// In steps: of the last 10 ms, but not before the history began. In questions: of their step.
TEST_F(QueryServicesTest, ClosingSpeedIsThatOfTheLastMotion) {
  const auto z = [](double since) { return 0.6 - 0.1 * since - 4.0 * since * since; };
  const auto speed = [&](double from, double to) { return (z(from) - z(to)) / (to - from); };
  const auto pose = [&](double since) {
    ros::Time::setNow(ros::Time(60.0 + since));
    send_tip(60.0 + since, {0.1, 0.2, z(since)});
  };
  const auto step = [&] {
    steps.add_tick();
    return evaluate().at(0).clearance.closing_speed;
  };
  tools[0].parameters.margin = 2.0;
  request.tool = "hook";
  request.motion = {};
  request.clearance = true;
  const auto asked = [&] { return services.query(request).clearance.closing_speed; };
  for (const double since : {0.0, 0.002, 0.004, 0.006}) pose(since);
  send_mesh(0.0, 0.0F);
  evaluate(std::chrono::seconds(1));  // The shape of 1.0 s has no pose.
  EXPECT_EQ(step(), 0.0) << "the history begins here";
  pose(0.008), pose(0.01);
  EXPECT_NEAR(step(), speed(0.006, 0.01), 1e-6);
  EXPECT_NEAR(asked(), speed(0.006, 0.01), 1e-6)
      << "a step without duration goes on from steps before";
  pose(0.012);
  EXPECT_NEAR(step(), speed(0.006, 0.012), 1e-6);
  for (const double since : {0.02, 0.03}) pose(since);
  EXPECT_NEAR(asked(), speed(0.012, 0.03), 1e-6);
  EXPECT_NEAR(step(), speed(0.02, 0.03), 1e-6);
  pose(0.034);
  EXPECT_NEAR(asked(), speed(0.03, 0.034), 1e-6);
  // At 0.024 s, TF interpolates.
  EXPECT_NEAR(step(), (0.6 * z(0.02) + 0.4 * z(0.03) - z(0.034)) / 0.01, 1e-6);
}

TEST_F(QueryServicesTest, AnEmptyNameStandsForTheOnlyOrgan) {
  const ContactArray named = services.query(request);
  request.organ = "";
  const ContactArray only = services.query(request);
  EXPECT_EQ(only.organ, "liver");
  EXPECT_EQ(only.contacts, named.contacts);
  OrganMesh other;
  other.organ = "kidney";
  other.vertices = heights(0.1F);
  other.triangles = {0, 1, 2};
  send_mesh(1.0, other);
  expect_refused(kInvalid, {"organ is empty; must be one of 'kidney', 'liver'"});
  for (const char* organ : {"kidney", "liver"}) {
    OrganMesh removal;
    removal.organ = organ;
    send_mesh(2.0, removal);
  }
  expect_refused(ContactArray::NO_MESH, {"the node has no organ"});
}

TEST_F(QueryServicesTest, SidesAreKnownWhenTheSurfaceIsInspected) {
  request.regions = request.placement = true;
  ContactArray answer = services.query(request);
  EXPECT_EQ(answer.regions.size(), 1u);
  EXPECT_EQ(answer.placement.tip, ToolPlacement::UNKNOWN);
  EXPECT_EQ(answer.placement.crossings.size(), 1u);
  send_tetrahedron();
  std::thread inspector([&] { organs.at("liver").surface()->find(); });
  organs.at("liver").surface()->wait_until_found(std::chrono::minutes(1));
  inspector.join();
  request.motion.tip.z = -0.6;
  EXPECT_EQ(services.query(request).placement.tip, ToolPlacement::INSIDE);
}

TEST_F(QueryServicesTest, ToolFromItsLastPublishedPose) {
  request.tool = "hook";
  request.motion = {};
  send_tip(1.0, kAboveOrgan);
  const ContactArray at_rest = services.query(request);  // There was no step yet.
  EXPECT_EQ(at_rest.status, ContactArray::OK) << at_rest.message;
  EXPECT_EQ(at_rest.step_start, at_rest.header.stamp);
  evaluate();
  send_tip(1.1, kBelow);
  send_tip(1.2, {0.1, 0.2, -0.4});
  const ContactArray answer = services.query(request);
  ASSERT_EQ(answer.status, ContactArray::OK) << answer.message;
  EXPECT_EQ(answer.tool, "hook");
  EXPECT_EQ(answer.step_start, ros::Time(1.0));
  EXPECT_EQ(answer.header.stamp, ros::Time(1.2));
  EXPECT_EQ(answer.contacts.size(), 1u);
  EXPECT_EQ(steps.history().at({"liver", 0}).last->stamp, ros::Time(1.0));  // It is left alone.
  request.header.stamp = ros::Time(1.05);
  EXPECT_EQ(services.query(request).header.stamp, ros::Time(1.05));
  request.mode = ContactArray::STATIC;
  EXPECT_EQ(services.query(request).step_start, ros::Time(1.05));
}

TEST_F(QueryServicesTest, ATransformBehindAnAnsweredStampIsTold) {
  request.tool = "hook";
  request.motion = {};
  send_tip(50.8, kAboveOrgan);
  send_vertices(50.8, 0.0);
  evaluate(std::chrono::milliseconds(20));  // The first shape waits no longer.
  ASSERT_EQ(steps.history().at({"liver", 0}).last->stamp, ros::Time(50.8));
  send_tip(50.01, kBelow);
  const ContactArray answer = services.query(request);
  EXPECT_EQ(answer.status, ContactArray::OK) << answer.message;
  EXPECT_EQ(answer.header.stamp, ros::Time(50.8));
  EXPECT_EQ(answer.step_start, ros::Time(50.8));
  EXPECT_TRUE(answer.path_incomplete);
  EXPECT_NE(answer.message.find("'hook_tip'"), std::string::npos) << answer.message;
}

TEST_F(QueryServicesTest, AToolOfTFMeetsTheOrganWhereItsLastStepLeftIt) {
  request.tool = "hook";
  request.motion = {};
  const auto shape_before = [&] {
    QueryQuestion question(request);
    question.complete({parameters, tools, pipeline}, true);
    return question.request({}).organ_before;
  };
  send_tip(1.0, kAboveOrgan);
  evaluate();
  EXPECT_EQ(shape_before(), nullptr) << "the step ended with the latest shape";
  send_vertices(1.1, 0.5);
  send_vertices(1.2, 0.75);
  ASSERT_TRUE(shape_before());
  EXPECT_EQ(shape_before()->vertices()[2], 0.0F) << "two shapes ago";
  parameters.organ_motion = false;
  EXPECT_EQ(shape_before(), nullptr);
  parameters.organ_motion = true;
  restart_sender();
  send_vertices(1.3, 0.5);
  EXPECT_EQ(shape_before(), nullptr) << "the shape of a sender that is gone";
}

TEST_F(QueryServicesTest, AWayThatIsNotWhollyKnownIsSaid) {
  request.tool = "hook";
  request.motion = {};
  send_tip(1.0, kAboveOrgan);
  evaluate();
  send_tip(2.0, kBelow);
  send_tip(15.0, kAboveOrgan);
  const ContactArray answer = services.query(request);
  EXPECT_EQ(answer.status, ContactArray::OK) << answer.message;
  EXPECT_TRUE(answer.path_incomplete);
  expect_words(answer.message, {"longer ago than transforms are kept"});
}

TEST_F(QueryServicesTest, PosesThatRestAreOfThePresentAlsoIfTheLastStepWasLater) {
  request.tool = "hook";
  request.motion = {};
  request.header.stamp = {};
  set_point(transforms, "liver_frame", "hook_tip", 0.0, kAboveOrgan, true);
  evaluate();
  ros::Time::setNow(ros::Time(60));
  tick();
  ros::Time::setNow(ros::Time(55));
  const ContactArray answer = services.query(request);
  EXPECT_EQ(answer.header.stamp, ros::Time(60)) << answer.message;
  EXPECT_EQ(answer.step_start, ros::Time(60));
}

TEST_F(QueryServicesTest, AQuestionStaysAsItIsWhileTheNodeGoesOn) {
  send_vertices(1.1, 0.5);
  request.tool = "hook";
  QueryQuestion question(request);
  question.complete({parameters, tools, pipeline}, false);
  for (int i = 0; i < 5; ++i) send_vertices(2.0 + i, 9.0);
  tools.clear();
  EXPECT_EQ(question.unanswered().mesh_stamp, ros::Time(1.1));
  EXPECT_EQ(question.unanswered().topology, 1u);
  const CollisionRequest asked = question.request({});
  EXPECT_EQ(asked.organ->vertices()[2], 0.5F);
  EXPECT_EQ(asked.organ_before->vertices()[2], 0.0F);
  EXPECT_EQ(asked.radius, 0.01);
}

TEST_F(QueryServicesTest, ARefusalLeavesWhatIsKnownInTheAnswer) {
  request.tool = "hook";
  request.motion = {};
  const ContactArray answer = services.query(request);
  EXPECT_EQ(answer.status, ContactArray::NO_TRANSFORM);
  EXPECT_EQ(answer.mesh_stamp, ros::Time(1.0));
  EXPECT_TRUE(answer.links.empty());
}

/// A carrier takes the tip from 0.3 m above the sheet to 0.3 m below it within a second.
TEST_F(QueryServicesTest, TheStampSaysWhereTheFrameOfTheMotionWas) {
  set_point(transforms, "liver_frame", "carrier", 4.0, {0.0, 0.0, 0.0});
  set_point(transforms, "liver_frame", "carrier", 5.0, {0.0, 0.0, -0.6});
  request.header.frame_id = "carrier";
  request.mode = ContactArray::STATIC;
  request.motion.tip = tf2::toMsg(kAboveOrgan);
  for (const auto& [stamp, touches] :
       {std::pair(4.25, false), std::pair(4.5, true), std::pair(0.0, true)}) {
    request.header.stamp = ros::Time(stamp);
    const ContactArray answer = services.query(request);
    EXPECT_EQ(answer.contacts.size(), touches ? 1u : 0u) << answer.message << stamp;
    EXPECT_EQ(answer.header.stamp, stamp > 0.0 ? ros::Time(stamp) : ros::Time(5.0));
  }
  request.header.stamp = ros::Time(3.0);
  EXPECT_EQ(services.query(request).status, ContactArray::NO_TRANSFORM);
}

TEST_F(QueryServicesTest, RefusesWithStatusValueAndWhatIsLegal) {
  struct Refusal {
    std::uint8_t status;
    std::vector<std::string> words;
    std::function<void(Single&)> edit;
    bool is_of_batches = true;  ///< a batch of one motion is refused with the same words
  };
  const auto of_tool = [](Single& r, const char* tool) {
    r.tool = tool;
    r.motion = {};
  };
  const auto in_mode = [](Single& r, std::uint8_t mode) -> Single& {
    r.mode = mode;
    return r;
  };
  const std::vector<Refusal> refusals = {
      {ContactArray::UNKNOWN_ORGAN, {"'spleen'", "'liver'"}, [](auto& r) { r.organ = "spleen"; }},
      {ContactArray::UNKNOWN_TOOL, {"'saw'", "'hook'"}, [&](auto& r) { of_tool(r, "saw"); }},
      {ContactArray::NO_TRANSFORM, {"hook_tip"}, [&](auto& r) { of_tool(r, "hook"); }, false},
      {kInvalid, {"motion is set", "as in TF"}, [](auto& r) { r.tool = "hook"; }, false},
      {kInvalid, {"mode is 5", "0 (STATIC) to 4"}, [&](auto& r) { in_mode(r, 5); }},
      {kInvalid, {"mode is 2", "1 (SWEPT)"}, [&](auto& r) { in_mode(r, 2).margin = 0.01; }},
      {kInvalid, {"mode is 3", "1 (SWEPT)"}, [&](auto& r) { in_mode(r, 3).clearance = true; }},
      {kInvalid, {"mode is 4", "1 (SWEPT)"}, [&](auto& r) { in_mode(r, 4).placement = true; }},
      {kInvalid, {}, [&](auto& r) { in_mode(r, 2).motion.tip = r.motion.trocar; }},
      {kInvalid, {"frame_id", "empty"}, [](auto& r) { r.header.frame_id = ""; }},
      {ContactArray::NO_TRANSFORM, {"nowhere"}, [](auto& r) { r.header.frame_id = "nowhere"; }},
      {kInvalid, {"radius", "-0.25", "positive"}, [](auto& r) { r.motion.radius = -0.25; }},
      {kInvalid, {"radius", "nan", "finite"}, [](auto& r) { r.motion.radius = kNan; }},
      {kInvalid, {"previous_tip", "inf"}, [](auto& r) { r.motion.previous_tip.y = kInfinity; }},
      {kInvalid, {"tool is empty"}, [](auto& r) { r.link_motion = jaw_goes_down(); }, false},
      {kInvalid, {"margin is -0.25", "positive and finite"}, [](auto& r) { r.margin = -0.25; }},
      {kInvalid, {"margin is nan", "positive and finite"}, [](auto& r) { r.margin = kNan; }},
      {kInvalid, {"margin is inf", "positive and finite"}, [](auto& r) { r.margin = kInfinity; }},
      {kInvalid, {"max_near is 7", "margin"}, [](auto& r) { r.max_near = 7; }, false}};
  const Single good = request;
  for (const Refusal& refusal : refusals) {
    request = good;
    refusal.edit(request);
    expect_refused(refusal.status, refusal.words);
    if (!refusal.is_of_batches) continue;
    const QueryCollisionBatch::Response batch = services.query_batch(batch_of({request.motion}));
    const ContactArray answer = services.query(request);
    if (batch.results.empty()) {
      EXPECT_EQ(batch.message, answer.message);
      EXPECT_EQ(batch.status, refusal.status);
    } else {
      EXPECT_EQ(batch.results[0], answer) << "also topology and mesh_stamp";
    }
  }
  request = good;
  request.mode = ContactArray::STATIC;
  request.motion.previous_tip.y = kInfinity;
  EXPECT_EQ(services.query(request).status, ContactArray::OK);  // Unused when static.
  parameters.max_batch = 3;
  std::vector<ToolMotion> motions(3, good.motion);
  EXPECT_EQ(services.query_batch(batch_of(motions)).results.size(), 3u);
  motions.push_back(good.motion);
  expect_refused(batch_of(motions), kInvalid,
                 "the batch has 4 motions; must be at most 3 (max_batch): ask in several batches");
}

TEST_F(QueryServicesTest, IllegalNamesAreRefusedInAShortAnswer) {
  const Single good = request;
  for (const std::string& name : {std::string(10'000'000, 'x'), std::string("a\nb")}) {
    for (std::string Single::*field : {&Single::organ, &Single::tool}) {
      request = good;
      request.*field = name;
      expect_refused(kInvalid, {field == &Single::organ ? "organ" : "tool", "256"});
      EXPECT_LT(serializationLength(services.query(request)), 4000u);
    }
    request = good;
    request.header.frame_id = name;
    expect_refused(kInvalid, {"header.frame_id", "256"});
    EXPECT_LT(serializationLength(services.query(request)), 4000u);
  }
}

TEST_F(QueryServicesTest, SweepsBackwardsInTimeAreRefused) {
  request.tool = "hook";
  request.motion = {};
  send_tip(1.0, kAboveOrgan);
  send_tip(1.2, kBelow);
  send_vertices(1.125, 0.0);
  evaluate();
  request.header.stamp = ros::Time(1.0625);
  expect_refused(kInvalid, {"'hook'", "1.062500000", "1.125000000"});
  request.mode = ContactArray::STATIC;
  EXPECT_EQ(services.query(request).status, ContactArray::OK);
  request.mode = ContactArray::SWEPT;
  request.header.stamp = ros::Time(1.125);
  const ContactArray at_rest = services.query(request);
  EXPECT_EQ(at_rest.status, ContactArray::OK) << at_rest.message;
  EXPECT_EQ(at_rest.step_start, at_rest.header.stamp);
}

TEST_F(QueryServicesTest, RemovedOrganAndStaleMesh) {
  parameters.mesh_timeout_sec = 2.0;
  ros::Time::setNow(ros::Time::now() + ros::Duration(2.5));
  expect_refused(ContactArray::STALE_MESH, {"'liver'", "2.5 s", "2"});
  expect_refused(batch_of({through()}), ContactArray::STALE_MESH, "'liver'");
  OrganMesh nothing;
  nothing.organ = "liver";
  organs.apply(boost::make_shared<OrganMesh>(nothing), ros::Time(51));
  expect_refused(ContactArray::NO_MESH, {"'liver'"});
}

TEST_F(QueryServicesTest, WhatIsNoRejectionIsAnsweredToo) {
  QueryServices broken(
      {parameters, tools, pipeline}, [](const std::function<void()>&) { throw std::bad_alloc(); },
      counters);
  const ContactArray answer = broken.query(request);
  EXPECT_EQ(answer.status, ContactArray::PICKER_FAILED);
  EXPECT_EQ(answer.message, "the query failed: std::bad_alloc");
  const QueryCollisionBatch::Response response = broken.query_batch(batch_of({through()}));
  EXPECT_EQ(response.status, ContactArray::PICKER_FAILED);
  EXPECT_EQ(response.message, "the query failed: std::bad_alloc");
}

TEST_F(BatchTest, EachMotionIsAnsweredInOrderAsAlone) {
  EXPECT_TRUE(answer().results.empty());
  add_random_shafts(203, -0.3);
  const std::vector<ContactArray> results = answer().results;
  ASSERT_EQ(results.size(), 203u);
  EXPECT_EQ(results[3].status, kInvalid);
  std::size_t contacts = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    Single one;
    one.header = batch.header;
    one.organ = batch.organ;
    one.mode = batch.mode;
    one.motion = batch.motions[i];
    const ContactArray alone = nodes[0]->services.query(one);
    EXPECT_EQ(results[i].contacts, alone.contacts) << i;
    EXPECT_EQ(results[i].status, alone.status) << i;
    EXPECT_EQ(results[i].message, alone.message) << i;
    contacts += alone.contacts.size();
  }
  EXPECT_GT(contacts, 100u);
}

TEST_F(BatchTest, AnEmptyNameStandsForAllOrgans) {
  add_random_shafts(50, -0.3);
  const auto of_liver = answer().results;
  for (const auto& node : nodes) {
    OrganMesh kidney = wavy_sheet(10, 0.5, 0.1F);
    kidney.organ = "kidney";
    node->send_mesh(1.0, kidney);
  }
  batch.organ = "kidney";
  const auto of_kidney = answer().results;
  batch.organ = "";
  const QueryCollisionBatch::Response of_all = answer();
  EXPECT_EQ(of_all.organs, (std::vector<std::string>{"kidney", "liver"}));
  ASSERT_EQ(of_all.results.size(), 100U);
  std::size_t first = 0;
  while (of_kidney[first].contacts.empty() && of_liver[first].contacts.empty()) ++first;
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(of_all.results[2 * i].contacts, of_kidney[i].contacts);
    EXPECT_EQ(of_all.results[2 * i + 1].contacts, of_liver[i].contacts);
  }
  batch.stop_at_first_contact = 1;
  EXPECT_EQ(answer().results.size(), 2 * (first + 1)) << "with all organs of the last motion";
}

TEST_F(BatchTest, NearFacesAndRegionsAreThoseOfAQuery) {
  add_random_shafts(3, -0.3);
  Single one;
  one.header = batch.header;
  one.organ = batch.organ;
  one.mode = batch.mode;
  one.motion = batch.motions[0];
  one.margin = batch.margin = 0.2;
  one.max_near = batch.max_near = 5;
  one.regions = batch.regions = 1;
  const ContactArray alone = nodes[0]->services.query(one), among = answer().results.at(0);
  EXPECT_EQ(among.near, alone.near);
  EXPECT_EQ(among.near.size(), 5U);
  EXPECT_EQ(among.regions, alone.regions);
  EXPECT_EQ(among.regions.size(), among.contacts.size());
}

TEST_F(BatchTest, EndsWithTheFirstMotionThatTouches) {
  add_random_shafts(200, 0.05);
  const std::vector<ToolMotion> motions = batch.motions;
  for (const std::size_t first : {0u, 15u, 87u, 199u}) {
    batch.motions = motions;
    batch.motions[first] = batch.motions.back() = through();
    batch.stop_at_first_contact = 0;
    std::vector<ContactArray> expected = answer().results;
    for (std::size_t i = 0; i < first; ++i) ASSERT_TRUE(expected[i].contacts.empty());
    ASSERT_FALSE(expected[first].contacts.empty());
    expected.resize(first + 1);
    batch.stop_at_first_contact = 1;
    EXPECT_EQ(answer().results, expected) << first;
  }
  batch.motions = motions;
  EXPECT_EQ(answer().results.size(), 200u) << "none touches";
  EXPECT_EQ(nodes[0]->counters.batches.load(), 9u);
  EXPECT_EQ(nodes[0]->counters.motions.load(), 4 * 200u + 1 + 16 + 88 + 200 + 200);
}

TEST_F(BatchTest, ResultsThatAreTooLargeAreRefused) {
  batch.motions.assign(5, through());
  QueryCollisionBatch::Response without_results;
  without_results.organs = {"liver"};
  const std::uint32_t none = serializationLength(without_results);
  const std::uint32_t all = serializationLength(answer()), one = (all - none) / 5;
  EXPECT_EQ(serializationLength(answer(static_cast<int>(all))), all);
  const QueryCollisionBatch::Response refused = answer(static_cast<int>(all - 1));
  EXPECT_EQ(refused.status, kInvalid);
  EXPECT_TRUE(refused.results.empty());
  EXPECT_EQ(refused.message, "the answers to the first 5 of 5 motions have " + std::to_string(all) +
                                 " bytes; a batch's must have at most " + std::to_string(all - 1) +
                                 " (max_batch_bytes): ask for fewer motions at once");
  expect_words(answer(static_cast<int>(all - 4 * one)).message, {"first 2 of 5"});
}

TEST_F(BatchTest, BytesAfterTheFirstContactDoNotCount) {
  add_random_shafts(200, 0.05);
  ToolMotion wide = through();
  wide.radius = 0.5;  // So many contacts that one answer is too large.
  batch.motions.push_back(through());
  batch.motions.insert(batch.motions.end(), 100, wide);
  EXPECT_EQ(answer(400'000).status, kInvalid);
  batch.stop_at_first_contact = 1;
  const std::vector<ContactArray> found = answer(400'000).results;
  ASSERT_EQ(found.size(), 201u);
  EXPECT_FALSE(found.back().contacts.empty());
}

TEST_F(BatchTest, EndsSoonWhenAsked) {
  add_random_shafts(1, 0.05);
  batch.motions.assign(500'000, batch.motions[0]);
  BatchNode& node = *nodes[1];
  node.parameters.max_batch = 500'000;
  auto answering =
      std::async(std::launch::async, [&] { return node.services.query_batch(batch).status; });
  EXPECT_EQ(answering.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout);
  node.services.end();
  EXPECT_EQ(answering.get(), ContactArray::PICKER_FAILED);
  EXPECT_EQ(node.services.query_batch(batch).message, "the query failed: the node is about to end");
}

/// The same motions, given in the organ's frame and in one that is elsewhere.
TEST_F(LinkQueriesTest, MotionsInAnotherFrameGiveTheSame) {
  const Eigen::Isometry3d T_liver_table =
      Eigen::Translation3d(0.5, -0.3, 0.2) *
      Eigen::AngleAxisd(0.9, Vector3d(0.2, 1.0, -0.6).normalized());
  const Eigen::Isometry3d T_table_liver = T_liver_table.inverse();
  set_transform(transforms, "liver_frame", "table", 4.0, T_liver_table);
  tools[0].parameters.radius = 0.01;
  request.tool = "hook";
  request.motion = through();
  request.motion.previous_tip.x = 0.4;
  for (const std::uint8_t mode : {ContactArray::SWEPT, ContactArray::STATIC}) {
    request.mode = mode;
    const ContactArray here = services.query(request);
    ASSERT_FALSE(here.contacts.empty()) << here.message;
    Single moved = request;
    moved.header.frame_id = "/table";
    for (geometry_msgs::Point* point : {&moved.motion.previous_trocar, &moved.motion.previous_tip,
                                        &moved.motion.trocar, &moved.motion.tip}) {
      *point = tf2::toMsg(Vector3d(T_table_liver * to_eigen(*point)));
    }
    for (auto* poses : {&moved.link_motion.previous, &moved.link_motion.links}) {
      for (geometry_msgs::Pose& pose : *poses) {
        pose = tf2::toMsg(Eigen::Isometry3d(T_table_liver * to_eigen(pose)));
        pose.orientation.x *= 1.0005;  // Senders round. It is normalised.
        pose.orientation.y *= 1.0005;
        pose.orientation.z *= 1.0005;
        pose.orientation.w *= 1.0005;
      }
    }
    if (mode == ContactArray::STATIC) {  // What is not used may be missing or illegal.
      moved.motion.previous_tip.x = kNan;
      moved.link_motion.previous.clear();
    }
    const ContactArray there = services.query(moved);
    ASSERT_EQ(there.status, ContactArray::OK) << there.message;
    EXPECT_EQ(there.header.stamp, ros::Time(4.0));
    EXPECT_EQ(there.step_start, ros::Time(4.0));
    EXPECT_EQ(there.header.frame_id, "liver_frame");
    ASSERT_EQ(there.contacts.size(), here.contacts.size());
    for (std::size_t i = 0; i < here.contacts.size(); ++i) {
      EXPECT_EQ(there.contacts[i].face, here.contacts[i].face);
      EXPECT_EQ(there.contacts[i].link, here.contacts[i].link);
      EXPECT_NEAR(there.contacts[i].fraction, here.contacts[i].fraction, 1e-9);
      EXPECT_NEAR(there.contacts[i].depth, here.contacts[i].depth, 1e-9);
      EXPECT_NEAR(there.contacts[i].point.x, here.contacts[i].point.x, 1e-9);
    }
    Batch batch = batch_of({moved.motion});
    batch.header = moved.header;
    batch.link_motions = {moved.link_motion};
    EXPECT_EQ(services.query_batch(batch).results, std::vector<ContactArray>{there});
    moved.header.stamp = ros::Time(5.0);
    EXPECT_EQ(services.query(moved).status, ContactArray::NO_TRANSFORM);
  }
}

TEST_F(LinkQueriesTest, TheTipIsKnownIfALinkHasItsFrame) {
  request.placement = true;
  send_tetrahedron();
  organs.at("liver").surface()->find();
  request.link_motion.links[0].position.z = 5.0;  // The wrist is outside, and the jaw inside.
  request.link_motion.links[1].position.z = -0.6;
  for (const auto& [frame, side] :
       std::map<std::string, std::uint8_t>{{"", ToolPlacement::UNKNOWN},
                                           {"arm/point", ToolPlacement::UNKNOWN},
                                           {"arm/wrist", ToolPlacement::OUTSIDE},
                                           {"arm/jaw", ToolPlacement::INSIDE}}) {
    tools[1].parameters.tip_frame = frame;
    EXPECT_EQ(services.query(request).placement.tip, side) << frame;
  }
}

TEST_F(LinkQueriesTest, RefuseFaultyTools) {
  tools[1].fault = "grasper: parameter 'robot_description' is not set";
  expect_refused(ContactArray::INVALID_TOOL, {"grasper: parameter"});
  Batch batch = batch_of({});
  batch.link_motions = {request.link_motion};
  expect_refused(batch, ContactArray::INVALID_TOOL, "grasper: parameter");
  batch.tool = "saw";
  expect_refused(batch, ContactArray::UNKNOWN_TOOL, "'grasper'");
}

TEST_F(LinkQueriesTest, RefuseIllegalMotionsWithTheirValue) {
  struct Refusal {
    std::vector<std::string> words;
    std::function<void(Single&)> edit;
  };
  const auto of_shaft = [](const char* tool, auto edit) {
    return [tool, edit](Single& r) {
      r.tool = tool;
      r.motion = resting_shaft();
      edit(r.motion);
    };
  };
  const auto jaws = [](Single& r) -> geometry_msgs::Pose& { return r.link_motion.links[1]; };
  const std::vector<Refusal> refusals = {
      {{"link_motion is set", "'probe' has no links"}, of_shaft("probe", [](auto&) {})},
      {{"motion is set", "'grasper' has no shaft"}, of_shaft("grasper", [](auto&) {})},
      {{"motion is not set", "'hook' has a shaft"}, [](auto& r) { r.tool = "hook"; }},
      {{"motion.radius is 0.02 m", "'hook'", "0.01 m"},
       of_shaft("hook", [](auto& motion) { motion.radius = 0.02; })},
      {{"motion.tip is (0.1, nan, 0.3)", "finite"},
       of_shaft("hook", [](auto& motion) { motion.tip.y = kNan; })},
      {{"mode is 3", "'grasper' has no shaft"}, [](auto& r) { r.mode = 3; }},
      {{"link_motion.links has 1 poses", "2", "'grasper'"},
       [](auto& r) { r.link_motion.links.pop_back(); }},
      {{"link_motion.previous has 0 poses", "2"}, [](auto& r) { r.link_motion.previous.clear(); }},
      {{"link_motion.links[1]", "'jaw'", "(0.1, nan, -0.3)", "finite"},
       [&](auto& r) { jaws(r).position.y = kNan; }},
      {{"link_motion.previous[0]", "'wrist'", "(inf, 0.2, 0.6)", "finite"},
       [](auto& r) { r.link_motion.previous[0].position.x = kInfinity; }},
      {{"link_motion.links[1]", "'jaw'", "(0, 0, 0, 0)", "length 1"},
       [&](auto& r) { jaws(r).orientation = {}; }},
      {{"link_motion.links[1]", "(0, 0, 0, 1.0011)", "length 1"},
       [&](auto& r) { jaws(r).orientation.w = 1.0011; }},
      {{"link_motion.previous[1]", "(nan, 0, 0, 1)", "length 1"},
       [](auto& r) { r.link_motion.previous[1].orientation.x = kNan; }}};
  const Single good = request;
  for (const Refusal& refusal : refusals) {
    request = good;
    refusal.edit(request);
    expect_refused(kInvalid, refusal.words);
  }
}

TEST_F(LinkQueriesTest, ListsOfABatchMustFitTheTool) {
  struct Row {
    std::string tool;
    std::size_t shafts, links;
    std::string refusal;  // Empty: the batch is answered.
  };
  const std::vector<Row> rows = {{"", 2, 0, ""},
                                 {"", 2, 2, "link_motions has 2 motions and tool is empty"},
                                 {"grasper", 0, 3, ""},
                                 {"grasper", 3, 3, "'grasper' has no shaft"},
                                 {"probe", 3, 0, ""},
                                 {"probe", 3, 3, "'probe' has no links"},
                                 {"hook", 3, 3, ""},
                                 {"hook", 3, 2, "motions has 3 motions and link_motions has 2"},
                                 {"hook", 3, 0, "equally many"}};
  for (const Row& row : rows) {
    request.tool = row.tool;
    Batch batch = batch_of(std::vector<ToolMotion>(row.shafts, resting_shaft()));
    for (ToolMotion& motion : batch.motions) motion.radius = row.tool.empty() ? 0.01 : 0.0;
    batch.link_motions.assign(row.links, jaw_goes_down());
    if (!row.refusal.empty()) {
      expect_refused(batch, kInvalid, row.refusal);
      continue;
    }
    const QueryCollisionBatch::Response response = services.query_batch(batch);
    EXPECT_EQ(response.results.size(), std::max(row.shafts, row.links)) << response.message;
    for (const ContactArray& result : response.results) {
      EXPECT_EQ(result.status, ContactArray::OK) << result.message;
    }
  }
}

TEST_F(LinkQueriesTest, ABatchOfAShaftHasTheToolsRadius) {
  request.tool = "probe";
  ToolMotion motion = resting_shaft();
  motion.tip = motion.previous_tip = tf2::toMsg(Vector3d(0.1, 0.2, 0.015));
  // The last one is a ball in the origin, which is on the sheet.
  Batch batch = batch_of({motion, motion, motion, ToolMotion()});
  batch.motions[1].radius = 0.02;
  batch.motions[2].radius = 0.03;
  const QueryCollisionBatch::Response response = services.query_batch(batch);
  ASSERT_EQ(response.results.size(), 4u) << response.message;
  ASSERT_EQ(response.results[0].contacts.size(), 1u) << response.results[0].message;
  EXPECT_NEAR(response.results[0].contacts[0].depth, 0.005, 1e-9);
  EXPECT_EQ(response.results[1].contacts, response.results[0].contacts);
  EXPECT_EQ(response.results[2].status, kInvalid);
  EXPECT_EQ(response.results[3].status, ContactArray::OK) << response.results[3].message;
  EXPECT_FALSE(response.results[3].contacts.empty());
}
