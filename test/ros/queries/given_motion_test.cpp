#include "ros/queries/given_motion.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "link_motion_fixture.hpp"
#include "ros/interface/conversions.hpp"

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
