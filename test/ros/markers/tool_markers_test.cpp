#include "ros/markers/tool_markers.hpp"

#include <gtest/gtest.h>

#include <set>

#include "hand_made_scenes.hpp"
#include "ros/markers/marker_shapes.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

namespace {

std::vector<Marker> markers(const Tool& tool, const ToolPose& pose) {
  MarkerSheet sheet;
  add_tool(tool, pose, "liver_frame", sheet);
  for (const Marker& marker : sheet.markers().markers) {
    EXPECT_EQ(marker.ns, "tools");
    EXPECT_EQ(marker.header.frame_id, "liver_frame");
  }
  return sheet.markers().markers;
}

Isometry3d pose_of(const Marker& marker) {
  const auto& p = marker.pose.position;
  const auto& q = marker.pose.orientation;
  Isometry3d pose(Eigen::Translation3d(p.x, p.y, p.z));
  pose.rotate(Eigen::Quaterniond(q.w, q.x, q.y, q.z));
  return pose;
}

Isometry3d tilted() {
  Isometry3d pose(Eigen::Translation3d(0.3, -0.1, 0.2));
  pose.rotate(Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()));
  return pose;
}

/// The marker of a tool with one link of one part.
Marker marker_of(const LinkPart& part) {
  Tool tool = grasper();
  tool.links = {{"jaw", {part}}};
  const auto all = markers(tool, {{}, {tilted()}});
  EXPECT_EQ(all.size(), 1u);
  return all.front();
}

}  // namespace

TEST(ToolMarkers, AShaftIsACapsule) {
  const auto shaft = markers(shaft_tool("hook", 0.25), {{{0, 0, 2}, {0, 4, 2}}, {}});
  ASSERT_EQ(shaft.size(), 3u);
  EXPECT_EQ(shaft[0].type, Marker::CYLINDER);
  EXPECT_DOUBLE_EQ(shaft[0].scale.x, 0.5);
  EXPECT_DOUBLE_EQ(shaft[0].scale.z, 4.0);
  EXPECT_TRUE((pose_of(shaft[0]) * Vector3d(0, 0, 2)).isApprox(Vector3d(0, 4, 2), 1e-12));
  EXPECT_EQ(shaft[1].type, Marker::SPHERE);
  EXPECT_DOUBLE_EQ(shaft[2].pose.position.y, 4.0);
  EXPECT_DOUBLE_EQ(shaft[2].scale.y, 0.5);
}

TEST(ToolMarkers, ABallHasAShaftWithoutLength) {
  const auto shaft = markers(shaft_tool("hook", 0.25), {{{1, 2, 3}, {1, 2, 3}}, {}});
  EXPECT_GT(shaft[0].scale.z, 0.0);
  EXPECT_TRUE(pose_of(shaft[0]).linear().isUnitary(1e-12));
}

TEST(ToolMarkers, ALinkMayBeASphere) {
  const Marker ball = marker_of(LinkPart::sphere({0.1, 0.2, 0.3}, 0.05));
  EXPECT_EQ(ball.type, Marker::SPHERE);
  EXPECT_DOUBLE_EQ(ball.scale.x, 0.1);
  EXPECT_TRUE(pose_of(ball).translation().isApprox(tilted() * Vector3d(0.1, 0.2, 0.3), 1e-12));
}

TEST(ToolMarkers, ALinkMayBeACylinder) {
  const Isometry3d place(Eigen::Translation3d(0.0, 0.1, 0.0));
  const Marker cylinder = marker_of(LinkPart::cylinder(place, 0.02, 0.3));
  EXPECT_EQ(cylinder.type, Marker::CYLINDER);
  EXPECT_NEAR(cylinder.scale.x, 0.04, 1e-5);
  EXPECT_NEAR(cylinder.scale.z, 0.3, 1e-5);
  const Vector3d end = tilted() * Vector3d(0.0, 0.1, 0.15);
  EXPECT_TRUE((pose_of(cylinder) * Vector3d(0, 0, 0.15)).isApprox(end, 1e-4));
}

TEST(ToolMarkers, ALinkMayBeABox) {
  const Marker box = marker_of(LinkPart::box(Isometry3d::Identity(), {0.1, 0.2, 0.3}));
  EXPECT_EQ(box.type, Marker::CUBE);
  // The marker's axes may be those of the box in another order.
  const Vector3d size(box.scale.x, box.scale.y, box.scale.z);
  const Vector3d extent = (tilted().linear().transpose() * pose_of(box).linear() * size).cwiseAbs();
  EXPECT_TRUE(extent.isApprox(Vector3d(0.1, 0.2, 0.3), 1e-4)) << extent.transpose();
}

TEST(ToolMarkers, ALinkMayBeAMesh) {
  const Marker mesh =
      marker_of(LinkPart::mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {FaceIndices{0, 1, 2}}}));
  EXPECT_EQ(mesh.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(mesh.points.size(), 3u);
  EXPECT_TRUE(pose_of(mesh).isApprox(tilted(), 1e-12));
}

TEST(ToolMarkers, ALargeMeshIsABox) {
  const std::vector<FaceIndices> faces(kMostFacesOfTool + 1, {0, 1, 2});
  EXPECT_EQ(marker_of(LinkPart::mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, faces})).type,
            Marker::CUBE);
}

using namespace organ_collision;

namespace {

SceneStep step(double seconds, const ToolPath& path) {
  return {at(seconds), answer_with({}), square().faces, path, 0.0};
}

Marker swept(const Tool& tool, const std::vector<SceneStep>& steps, double now) {
  std::vector<const SceneStep*> pointers;
  for (const SceneStep& step : steps) pointers.push_back(&step);
  MarkerSheet sheet;
  add_swept(tool, pointers, "liver_frame", at(now), sheet);
  return find_marker(sheet.markers(), "swept");
}

const Tool kHook = shaft_tool("hook", 0.25);
const ShaftAxis kBegin{{0, 0, 1}, {0, 0, 0}}, kTurned{{0, 0, 1}, {1, 0, 0}};
const ShaftAxis kMoved{{0, 2, 1}, {1, 2, 0}};

}  // namespace

TEST(SweptMarkers, EachLegSweepsATriangleOrAQuadrangle) {
  const Marker marker =
      swept(kHook, {step(0.0, {{0.0, kBegin}, {0.5, kTurned}, {1.0, kMoved}})}, 0.1);
  ASSERT_EQ(marker.points.size(), 9u);
  EXPECT_EQ(marker.colors.size(), 9u);
}

TEST(SweptMarkers, TheTrailFades) {
  const ToolPath turn{{0.0, kBegin}, {1.0, kTurned}};
  const Marker marker = swept(kHook, {step(-9.0, turn), step(0.0, turn), step(0.2, turn)}, 0.3);
  ASSERT_EQ(marker.colors.size(), 6u);  // Nothing is left of the first step.
  const float full = colours::swept().a;
  EXPECT_NEAR(marker.colors[0].a, full * (1.0 - 0.1 / kFadeSec), 1e-5);
  EXPECT_NEAR(marker.colors[3].a, full * (1.0 - 0.3 / kFadeSec), 1e-5);
}

TEST(SweptMarkers, ALongTrailIsCut) {
  ToolPath path;
  for (int i = 0; i < 3000; ++i) path.push_back({i / 2999.0, i % 2 ? kBegin : kTurned});
  EXPECT_EQ(swept(kHook, {step(0.0, path)}, 0.0).points.size(), 3 * kMostLegs);
}

TEST(SweptMarkers, AToolAtRestSweepsNothing) {
  EXPECT_EQ(swept(kHook, {step(0.0, {{0.0, kBegin}}), step(0.0, {})}, 0.0).type, -1);
  EXPECT_EQ(swept(kHook, {step(0.0, {{0.0, kBegin}, {1.0, kBegin}})}, 0.0).type, -1);
}

TEST(SweptMarkers, LinksSweepWithTheirLongestAxis) {
  Tool tool = grasper();
  tool.links = {{"jaw", {LinkPart::box(Eigen::Isometry3d::Identity(), {0.01, 0.2, 0.02})}}};
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.translation().x() = 0.5;
  const Marker marker = swept(
      tool, {step(0.0, {{0.0, {}, {Eigen::Isometry3d::Identity()}}, {1.0, {}, {moved}}})}, 0.0);
  ASSERT_EQ(marker.points.size(), 6u);
  double area = 0.0;
  for (std::size_t i = 0; i < 6; i += 3) {
    const Eigen::Vector3d a = point(marker, i);
    area += 0.5 * (point(marker, i + 1) - a).cross(point(marker, i + 2) - a).norm();
  }
  EXPECT_NEAR(area, 0.5 * 0.2, 1e-6);
}

TEST(Visibility, FallsFromOneToZero) {
  EXPECT_EQ(visibility(at(0.0), at(0.0)), 1.0);
  EXPECT_NEAR(visibility(at(0.0), at(0.25 * kFadeSec)), 0.75, 1e-6);
  EXPECT_EQ(visibility(at(0.0), at(2.0 * kFadeSec)), 0.0);
  EXPECT_EQ(visibility(at(1.0), at(0.0)), 1.0);
}

using namespace organ_collision;
using visualization_msgs::MarkerArray;

namespace {

/// A hook whose hand is 20 mm below its proxy. The hook pushes a surface in the plane z = 0 down.
ProxyView held_hook() {
  ProxyView view;
  view.tool = shaft_tool("hook", 0.005);
  view.frame = "liver_frame";
  view.hand = ToolPose{{{0.1, 0.2, 0.3}, {0.1, 0.2, -0.015}}};
  view.answer.state = ProxyStatus::kTouching;
  view.answer.proxy = ToolPose{{{0.1, 0.2, 0.3}, {0.1, 0.2, 0.005}}};
  view.answer.center = view.hand->axis.tip;
  view.answer.pull = {0.0, 0.0, 0.02};
  ProxyContact contact;
  contact.contact.point = {0.1, 0.2, 0.0};
  contact.contact.normal = {0.0, 0.0, -1.0};
  contact.load = 0.02;
  view.answer.contacts = {contact};
  view.force = 6.04;
  view.size = 0.2;
  return view;
}

MarkerArray markers_of(const ProxyView& view) {
  MarkerSheet sheet;
  add_proxy(view, sheet);
  for (const Marker& marker : sheet.markers().markers) {
    EXPECT_EQ(marker.header.frame_id, "liver_frame") << marker.ns;
  }
  return sheet.take();
}

std::set<std::string> names_of(const MarkerArray& array) {
  std::set<std::string> names;
  for (const Marker& marker : array.markers) names.insert(marker.ns);
  return names;
}

/// The point of a list that is farthest along `direction`.
Vector3d farthest(const Marker& list, const Vector3d& direction) {
  Vector3d best = point(list, 0);
  for (std::size_t i = 1; i < list.points.size(); ++i) {
    if (direction.dot(point(list, i) - best) > 0.0) best = point(list, i);
  }
  return best;
}

}  // namespace

TEST(ProxyMarkers, AHeldProxyIsSolidAndItsHandTranslucent) {
  const MarkerArray all = markers_of(held_hook());
  EXPECT_EQ(names_of(all), (std::set<std::string>{"proxy", "hand", "spring", "loads", "state"}));
  const Marker proxy = find_marker(all, "proxy"), hand = find_marker(all, "hand");
  EXPECT_EQ(proxy.color.a, 1.0F);
  EXPECT_LT(hand.color.a, 1.0F);
  EXPECT_DOUBLE_EQ(proxy.scale.z, 0.295);
  EXPECT_DOUBLE_EQ(hand.scale.z, 0.315);
}

TEST(ProxyMarkers, TheSpringJoinsHandAndProxy) {
  const Marker spring = find_marker(markers_of(held_hook()), "spring");
  ASSERT_EQ(spring.points.size(), 2u);
  EXPECT_TRUE(point(spring, 0).isApprox(Vector3d(0.1, 0.2, -0.015), 1e-12));
  EXPECT_TRUE(point(spring, 1).isApprox(Vector3d(0.1, 0.2, 0.005), 1e-12));
  EXPECT_EQ(spring.color, colours::proxy(ProxyStatus::kTouching));
}

TEST(ProxyMarkers, AnArrowShowsEachLoadAndTheLongestOneTheGreatest) {
  ProxyView view = held_hook();
  ProxyContact other = view.answer.contacts.front();
  other.contact.point = {0.5, 0.2, 0.0};
  other.contact.normal = {1.0, 0.0, 0.0};
  other.load = 0.005;
  view.answer.contacts.push_back(other);
  const Marker arrows = find_marker(markers_of(view), "loads");
  EXPECT_EQ(arrows.colors.size(), arrows.points.size());
  EXPECT_NEAR(farthest(arrows, {0, 0, -1}).z(), 0.0, 0.004);  // The head of the small one is wide.
  EXPECT_NEAR(farthest(arrows, {0, 0, 1}).z(), 0.02, 1e-12);  // A tenth of the scene's size.
  EXPECT_TRUE(farthest(arrows, {1, 0, 0}).isApprox(other.contact.point, 1e-12));
  const std::size_t corners_of_one = arrows.points.size() / 2;
  const Vector3d tail = point(arrows, corners_of_one);
  EXPECT_TRUE(tail.isApprox(Vector3d(0.495, 0.2, 0.0), 1e-12)) << tail.transpose();
}

TEST(ProxyMarkers, ANeedleLoadsTheTissueWhereItCrosses) {
  ProxyView view = held_hook();
  view.answer.state = ProxyStatus::kPunctured;
  view.answer.contacts.clear();
  view.answer.crossings = {{0, 7, {0.2, 0.3, 0.5}, 0.8, {0.1, 0.2, 0.0}, {0.0, 0.0, -0.01}}};
  const Marker arrows = find_marker(markers_of(view), "loads");
  EXPECT_TRUE(farthest(arrows, {0, 0, -1}).isApprox(Vector3d(0.1, 0.2, 0.0), 1e-12));
}

TEST(ProxyMarkers, AFreeProxyHidesItsHand) {
  ProxyView view = held_hook();
  view.answer.state = ProxyStatus::kFree;
  view.answer.proxy = *view.hand;
  view.answer.pull.setZero();
  view.answer.contacts.front().load = 0.0;
  EXPECT_EQ(names_of(markers_of(view)), (std::set<std::string>{"proxy", "state"}));
}

TEST(ProxyMarkers, WithoutAnAnswerThereIsOnlyTheHandAndTheReason) {
  ProxyView view = held_hook();
  view.answer.state = ProxyStatus::kNoAnswer;
  view.answer.message = "there is no organ";
  const MarkerArray all = markers_of(view);
  EXPECT_EQ(names_of(all), (std::set<std::string>{"hand", "state"}));
  EXPECT_EQ(find_marker(all, "state").text, "hook: NO_ANSWER: there is no organ");
  EXPECT_EQ(find_marker(all, "state").color, colours::failure());
  view.hand.reset();
  EXPECT_EQ(names_of(markers_of(view)), (std::set<std::string>{"state"}));
}

TEST(ProxyMarkers, TheTextIsAboveTheTrocarAndTellsStateAndForce) {
  const Marker text = find_marker(markers_of(held_hook()), "state");
  EXPECT_EQ(text.text, "hook: TOUCHING, 6.0 N");
  EXPECT_GT(text.pose.position.z, 0.3);
  EXPECT_DOUBLE_EQ(text.pose.position.x, 0.1);
}

TEST(ProxyMarkers, LinksHaveProxiesToo) {
  ProxyView view = held_hook();
  view.tool = grasper();
  const Eigen::Isometry3d place(Eigen::Translation3d(0.0, 0.0, 0.1));
  view.hand = ToolPose{{Vector3d::Zero(), Vector3d::Zero()}, {place, place}};
  view.answer.proxy = *view.hand;
  const MarkerArray all = markers_of(view);
  const auto count = std::count_if(all.markers.begin(), all.markers.end(),
                                   [](const Marker& marker) { return marker.ns == "proxy"; });
  EXPECT_EQ(count, 2);
}

TEST(ProxyMarkers, EachStateHasAColourAndAName) {
  std::set<std::string> names;
  std::set<float> colours;
  for (int state = 0; state <= 4; ++state) {
    names.insert(name_of(static_cast<ProxyStatus>(state)));
    colours.insert(colours::proxy(static_cast<ProxyStatus>(state)).b);
  }
  EXPECT_EQ(names,
            (std::set<std::string>{"NO_ANSWER", "FREE", "TOUCHING", "SQUEEZED", "PUNCTURED"}));
  EXPECT_EQ(colours.size(), 5u);
}
