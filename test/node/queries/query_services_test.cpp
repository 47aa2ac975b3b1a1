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
