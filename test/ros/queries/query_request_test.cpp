#include "ros/queries/query_request.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <thread>

#include "organ_collision/query/collision_query.hpp"
#include "query_fixtures.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/steps/contact_array.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

using namespace organ_collision;

namespace {

/// The status with which a check refuses, and its message; OK: it does not refuse.
std::pair<int, std::string> refusal(const std::function<void()>& check) {
  try {
    check();
  } catch (const Rejection& rejection) {
    return {rejection.status(), rejection.what()};
  }
  return {ContactArray::OK, ""};
}

}  // namespace

TEST(QueryChecks, RefusalsNameAllParts) {
  const auto [status, message] = refusal([] { refuse("margin is ", -0.5, " m"); });
  EXPECT_EQ(status, ContactArray::INVALID_REQUEST);
  EXPECT_EQ(message, "margin is -0.5 m");
}

TEST(QueryChecks, Modes) {
  for (int mode = 0; mode <= ContactArray::PAPER_NAIVE; ++mode) {
    EXPECT_EQ(static_cast<int>(checked_mode(static_cast<std::uint8_t>(mode))), mode);
  }
  EXPECT_EQ(refusal([] { checked_mode(255); }).second,
            "mode is 255; legal are 0 (STATIC) to 4 (PAPER_NAIVE)");
}

TEST(QueryChecks, Tools) {
  Tool faulty = grasper();
  faulty.fault = "grasper: no URDF";
  const auto of_fault = refusal([&] { check_tool(faulty, QueryMode::kPaperNaive); });
  EXPECT_EQ(of_fault.first, ContactArray::INVALID_TOOL);
  EXPECT_EQ(of_fault.second, "grasper: no URDF");
  for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept}) {
    EXPECT_EQ(refusal([&] { check_tool(grasper(), mode); }).first, ContactArray::OK);
  }
  for (const QueryMode mode :
       {QueryMode::kPaperStatic, QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
    const auto refused = refusal([&] { check_tool(grasper(), mode); });
    EXPECT_EQ(refused.first, ContactArray::INVALID_REQUEST);
    EXPECT_NE(refused.second.find("'grasper' has no shaft"), std::string::npos) << refused.second;
    EXPECT_EQ(refusal([&] { check_tool(shaft_tool("hook", 0.01), mode); }).first, ContactArray::OK);
  }
}

using namespace organ_collision;

namespace {

OrganShape shape(float z) {
  OrganShape shape;
  shape.mesh =
      std::make_shared<const TriangleMesh>(TriangleMesh({-1, -1, z, 1, -1, z, 1, 1, z}, {0, 1, 2}));
  shape.surface = std::make_shared<OrganSurface>(*shape.mesh);
  return shape;
}

/// A snapshot of an organ that has moved.
QuerySnapshot moved() {
  QuerySnapshot snapshot;
  snapshot.latest = shape(0.0F);
  snapshot.previous = shape(1.0F);
  return snapshot;
}

QueryCollision::Request full_request() {
  QueryCollision::Request request;
  request.mode = ContactArray::SWEPT;
  request.regions = request.clearance = request.organ_motion = 1;
  request.margin = 0.25;
  request.max_near = 7;
  return request;
}

}  // namespace

TEST(QueryExtras, OfASingleQueryReachTheRequest) {
  QuerySnapshot snapshot = moved();
  const CollisionRequest plain = request_about(snapshot, checked_extras(QueryCollision::Request()));
  EXPECT_EQ(plain.organ, snapshot.latest.mesh.get());
  EXPECT_EQ(plain.organ_before, nullptr);
  EXPECT_EQ(plain.mode, QueryMode::kStatic);
  EXPECT_EQ(plain.links, nullptr);
  EXPECT_FALSE(plain.regions || plain.clearance || plain.placement);

  snapshot.tool = with_links(shaft_tool("hook", 0.01));
  const CollisionRequest full = request_about(snapshot, checked_extras(full_request()));
  EXPECT_EQ(full.mode, QueryMode::kSwept);
  EXPECT_EQ(full.organ_before, snapshot.previous.mesh.get());
  EXPECT_TRUE(full.regions && full.clearance);
  EXPECT_EQ(full.margin, 0.25);
  EXPECT_EQ(full.max_near, 7u);
  EXPECT_EQ(full.radius, 0.01);
  EXPECT_EQ(full.links, &snapshot.tool->links);
}

TEST(QueryExtras, TheOrganMovesInSweptQueriesAlone) {
  const QuerySnapshot snapshot = moved();
  QueryCollision::Request request;
  request.organ_motion = 1;
  for (int mode = 0; mode <= ContactArray::PAPER_NAIVE; ++mode) {
    request.mode = static_cast<std::uint8_t>(mode);
    const bool moves = request_about(snapshot, checked_extras(request)).organ_before != nullptr;
    EXPECT_EQ(moves, mode == ContactArray::SWEPT) << mode;
  }
}

TEST(QueryExtras, ABatchHasNeitherRegionsNorNearFaces) {
  QueryCollisionBatch::Request batch;
  batch.mode = ContactArray::SWEPT;
  batch.margin = 0.5;
  batch.clearance = batch.organ_motion = 1;
  const QuerySnapshot snapshot = moved();
  const CollisionRequest request = request_about(snapshot, checked_extras(batch));
  EXPECT_EQ(request.margin, 0.5);
  EXPECT_TRUE(request.clearance);
  EXPECT_EQ(request.organ_before, snapshot.previous.mesh.get());
  EXPECT_FALSE(request.regions);
  EXPECT_EQ(request.max_near, 0u);
  batch.margin = -1.0;
  EXPECT_THROW(checked_extras(batch), Rejection);
  batch.margin = 0.0;
  batch.mode = ContactArray::PAPER_SWEPT;
  EXPECT_THROW(checked_extras(batch), Rejection);
}

TEST(QueryExtras, SidesWaitForTheInspectionOfTheSurface) {
  const QuerySnapshot snapshot = moved();
  QueryCollision::Request request;
  request.placement = 1;
  EXPECT_EQ(request_about(snapshot, checked_extras(request)).surface_topology, nullptr);
  std::thread inspector([&] { snapshot.latest.surface->find(); });
  snapshot.latest.surface->wait_until_found(std::chrono::minutes(1));
  inspector.join();
  EXPECT_EQ(request_about(snapshot, checked_extras(request)).surface_topology,
            &snapshot.latest.surface->topology());
}

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

const double kNan = std::nan("");

Vector3d random_vector(std::mt19937& random) {
  std::normal_distribution<double> number(0.3, 2.0);
  const double x = number(random), y = number(random), z = number(random);
  return {x, y, z};
}

geometry_msgs::Point random_point(std::mt19937& random) {
  return tf2::toMsg(random_vector(random));
}

Eigen::Isometry3d random_transform(std::mt19937& random) {
  return Eigen::Translation3d(random_vector(random)) *
         Eigen::AngleAxisd(0.7, random_vector(random).normalized());
}

ToolMotion random_motion(std::mt19937& random) {
  ToolMotion motion;
  motion.previous_trocar = random_point(random);
  motion.previous_tip = random_point(random);
  motion.trocar = random_point(random);
  motion.tip = random_point(random);
  motion.radius = 0.25;
  return motion;
}

CollisionRequest in_mode(QueryMode mode) {
  CollisionRequest request;
  request.mode = mode;
  return request;
}

}  // namespace

TEST(GivenMotion, OfAShaftIsMovedIntoTheOrgansFrame) {
  std::mt19937 random(3);
  const ToolMotion motion = random_motion(random);
  QuerySnapshot snapshot;
  snapshot.T_organ_motion = random_transform(random);
  const Eigen::Isometry3d& T = snapshot.T_organ_motion;
  CollisionRequest request = in_mode(QueryMode::kSwept);
  set_motion({&motion, nullptr}, snapshot, request);
  const ToolPath& path = request.path;
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[0].fraction, 0.0);
  EXPECT_EQ(path[1].fraction, 1.0);
  EXPECT_EQ(path[0].axis.trocar, T * to_eigen(motion.previous_trocar));
  EXPECT_EQ(path[0].axis.tip, T * to_eigen(motion.previous_tip));
  EXPECT_EQ(path[1].axis.trocar, T * to_eigen(motion.trocar));
  EXPECT_EQ(path[1].axis.tip, T * to_eigen(motion.tip));
  EXPECT_EQ(request.radius, 0.25);
}

TEST(GivenMotion, OfAShaftAtItsEndAlone) {
  std::mt19937 random(3);
  ToolMotion motion = random_motion(random);
  motion.previous_tip.x = kNan;  // not used
  CollisionRequest request = in_mode(QueryMode::kStatic);
  set_motion({&motion, nullptr}, {}, request);
  ASSERT_EQ(request.path.size(), 1u);
  EXPECT_EQ(request.path[0].axis.tip, to_eigen(motion.tip));
}

TEST(GivenMotion, OfShaftAndLinks) {
  std::mt19937 random(5);
  QuerySnapshot snapshot;
  snapshot.T_organ_motion = random_transform(random);
  snapshot.tool = with_links(shaft_tool("hook", 0.01));
  ToolMotion shaft = random_motion(random);
  shaft.radius = 0.0;
  LinkMotion links;
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 4; ++i) {
    poses.push_back(random_transform(random));
    geometry_msgs::Pose pose = tf2::toMsg(poses.back());
    pose.orientation.x *= 1.0005;  // Senders round. It is normalised.
    pose.orientation.y *= 1.0005;
    pose.orientation.z *= 1.0005;
    pose.orientation.w *= 1.0005;
    (i < 2 ? links.previous : links.links).push_back(pose);
  }
  CollisionRequest request = in_mode(QueryMode::kSwept);
  set_motion({&shaft, &links}, snapshot, request);
  ASSERT_EQ(request.path.size(), 2u);
  EXPECT_EQ(request.path[1].axis.tip, snapshot.T_organ_motion * to_eigen(shaft.tip));
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Isometry3d& pose = request.path[i / 2].links.at(i % 2);
    EXPECT_TRUE(pose.isApprox(snapshot.T_organ_motion * poses[i], 1e-14)) << i;
  }
  request.mode = QueryMode::kStatic;
  links.previous.clear();
  set_motion({&shaft, &links}, snapshot, request);
  ASSERT_EQ(request.path.size(), 1u);
  EXPECT_TRUE(request.path[0].links.at(1).isApprox(snapshot.T_organ_motion * poses[3], 1e-14));
}

TEST(GivenMotion, TheTipOfLinksIsKnownIfALinkHasItsFrame) {
  std::mt19937 random(7);
  QuerySnapshot snapshot;
  snapshot.T_organ_motion = random_transform(random);
  snapshot.tool = grasper();
  LinkMotion links;
  for (int i = 0; i < 2; ++i) links.links.push_back(tf2::toMsg(random_transform(random)));
  CollisionRequest request = in_mode(QueryMode::kStatic);
  const auto tip = [&](const std::string& frame) {
    snapshot.tool->parameters.tip_frame = frame;
    request.tip = Vector3d(1.0, 2.0, 3.0);
    set_motion({nullptr, &links}, snapshot, request);
    return request.tip;
  };
  EXPECT_EQ(tip(""), std::nullopt);
  EXPECT_EQ(tip("arm/point"), std::nullopt);
  const std::optional<Vector3d> found = tip("arm/jaw");
  EXPECT_EQ(found, request.path[0].links[1].translation());
}

TEST_F(LinkMotionTest, IllegalMotionsAreRefusedWithTheirValue) {
  const QueryCollision::Request good = request;
  EXPECT_EQ(services.query(good).status, ContactArray::OK) << services.query(good).message;
  const auto refuses = [&](const std::vector<std::string>& words, auto set) {
    request = good;
    set(request);
    expect_refused(words);
  };
  using Single = QueryCollision::Request;
  refuses({"link_motion", "tool is empty"}, [](Single& r) { r.tool = ""; });
  refuses({"link_motion is set", "'probe' has no links"}, [](Single& r) {
    r.tool = "probe";
    r.motion = resting_shaft();
  });
  refuses({"link_motion.links has 1 poses", "2", "'grasper'"},
          [](Single& r) { r.link_motion.links.pop_back(); });
  refuses({"link_motion.previous has 0 poses", "2"},
          [](Single& r) { r.link_motion.previous.clear(); });
  refuses({"link_motion.previous has 3 poses", "2"},
          [](Single& r) { r.link_motion.previous.emplace_back(); });
  refuses({"link_motion.links[1]", "'jaw'", "(0, nan, 0)", "finite"}, [](Single& r) {
    r.link_motion.links[1] = at({0.0, kNan, 0.0});
  });
  refuses({"link_motion.previous[0]", "'wrist'", "(inf, 0, 0)", "finite"}, [](Single& r) {
    r.link_motion.previous[0] = at({std::numeric_limits<double>::infinity(), 0.0, 0.0});
  });
  refuses({"link_motion.links[0]", "'wrist'", "(0, 0, 0, 0)", "length 1"},
          [](Single& r) { r.link_motion.links[0].orientation = {}; });
  refuses({"link_motion.links[0]", "(0, 0, 0, 1.0011)", "length 1"},
          [](Single& r) { r.link_motion.links[0].orientation.w = 1.0011; });
  refuses({"link_motion.previous[1]", "(nan, 0, 0, 1)", "length 1"},
          [](Single& r) { r.link_motion.previous[1].orientation.x = kNan; });
  refuses({"motion is set", "'grasper' has no shaft"},
          [](Single& r) { r.motion = resting_shaft(); });
  refuses({"motion is not set", "'hook' has a shaft"}, [](Single& r) { r.tool = "hook"; });
  refuses({"motion.radius is 0.02 m", "'hook'", "0.01 m"}, [](Single& r) {
    r.tool = "hook";
    r.motion = resting_shaft();
    r.motion.radius = 0.02;
  });
  refuses({"motion.tip is (0, nan, 0)", "finite"}, [](Single& r) {
    r.tool = "hook";
    r.motion = resting_shaft();
    r.motion.tip = tf2::toMsg(Vector3d(0.0, kNan, 0.0));
  });
  refuses({"mode is 3", "'grasper' has no shaft"},
          [](Single& r) { r.mode = ContactArray::PAPER_SWEPT; });
}

TEST_F(LinkMotionTest, ListsOfABatchMustFitTheTool) {
  const auto expect = [&](const std::string& tool, std::size_t shafts, std::size_t links,
                          const std::string& word) {
    QueryCollisionBatch::Request batch;
    batch.header = request.header;
    batch.organ = request.organ;
    batch.tool = tool;
    batch.mode = ContactArray::SWEPT;
    batch.motions.assign(shafts, resting_shaft());
    for (ToolMotion& motion : batch.motions) motion.radius = tool.empty() ? 0.01 : 0.0;
    batch.link_motions.assign(links, jaw_goes_down());
    const QueryCollisionBatch::Response response = services.query_batch(batch);
    if (word.empty()) {
      EXPECT_EQ(response.status, ContactArray::OK) << response.message;
      EXPECT_EQ(response.results.size(), std::max(shafts, links));
      for (const ContactArray& result : response.results) {
        EXPECT_EQ(result.status, ContactArray::OK) << result.message;
      }
    } else {
      EXPECT_EQ(response.status, ContactArray::INVALID_REQUEST);
      EXPECT_NE(response.message.find(word), std::string::npos) << response.message;
      EXPECT_TRUE(response.results.empty());
    }
  };
  expect("", 2, 0, "");
  expect("", 2, 2, "link_motions has 2 motions and tool is empty");
  expect("grasper", 0, 3, "");
  expect("grasper", 3, 3, "'grasper' has no shaft");
  expect("probe", 3, 0, "");
  expect("probe", 3, 3, "'probe' has no links");
  expect("hook", 3, 3, "");
  expect("hook", 3, 2, "motions has 3 motions and link_motions has 2");
  expect("hook", 3, 0, "equally many");
}

using namespace organ_collision;

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
