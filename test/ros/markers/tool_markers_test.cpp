#include "ros/markers/tool_markers.hpp"

#include <gtest/gtest.h>

#include <set>

#include "ros/messages/conversions.hpp"
#include "test/ros/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

std::vector<Marker> markers_of(const Tool& tool, const ToolPose& pose) {
  MarkerArray picture;
  add_tool(tool, pose, {"tools", "liver_frame", colours::kTool}, picture);
  return picture.markers;
}

Isometry3d tilted() {
  return Eigen::Translation3d(0.3, -0.1, 0.2) *
         Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized());
}

/// The marker of a tool with one link of one part.
Marker marker_of(const LinkPart& part) {
  Tool tool = grasper();
  tool.links = {{"jaw", {part}}};
  return markers_of(tool, {{}, {tilted()}}).at(0);
}

SceneStep step(double seconds, const ToolPath& path) {
  return {at(seconds), answer_with({}), square().mesh->shared_faces(), path, 0.0};
}

/// The trail of a tool; a marker without points if there is none.
Marker swept(const Tool& tool, const std::vector<SceneStep>& steps, double now) {
  std::vector<const SceneStep*> pointers;
  for (const SceneStep& step : steps) pointers.push_back(&step);
  MarkerArray picture;
  add_swept(tool, pointers, "liver_frame", at(now), picture);
  return picture.markers.empty() ? Marker() : picture.markers[0];
}

const Tool kHook = shaft_tool("hook", 0.25);
const ShaftAxis kBegin{{0, 0, 1}, {0, 0, 0}}, kTurned{{0, 0, 1}, {1, 0, 0}};
const ShaftAxis kMoved{{0, 2, 1}, {1, 2, 0}};

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
  MarkerArray picture;
  add_proxy(view, picture);
  return picture;
}

std::set<std::string> names_of(const MarkerArray& array) {
  std::set<std::string> names;
  for (const Marker& marker : array.markers) names.insert(marker.ns);
  return names;
}

}  // namespace

TEST(ToolMarkers, AShaftIsACapsule) {
  const auto shaft = markers_of(kHook, {{{0, 0, 2}, {0, 4, 2}}, {}});
  ASSERT_EQ(shaft.size(), 3u);
  EXPECT_EQ(shaft[0].type, Marker::CYLINDER);
  EXPECT_EQ(shaft[0].ns, "tools");
  EXPECT_EQ(shaft[0].header.frame_id, "liver_frame");
  EXPECT_DOUBLE_EQ(shaft[0].scale.x, 0.5);
  EXPECT_DOUBLE_EQ(shaft[0].scale.z, 4.0);
  EXPECT_TRUE((to_eigen(shaft[0].pose) * Vector3d(0, 0, 2)).isApprox(Vector3d(0, 4, 2), 1e-12));
  EXPECT_EQ(shaft[1].type, Marker::SPHERE);
  EXPECT_DOUBLE_EQ(shaft[2].pose.position.y, 4.0);
  EXPECT_DOUBLE_EQ(shaft[2].scale.y, 0.5);
  const auto ball = markers_of(kHook, {{{1, 2, 3}, {1, 2, 3}}, {}});
  EXPECT_GT(ball[0].scale.z, 0.0);
  EXPECT_TRUE(to_eigen(ball[0].pose).linear().isUnitary(1e-12));
}

TEST(ToolMarkers, ALinkIsASphereACylinderOrABox) {
  const Marker ball = marker_of(LinkPart::sphere({0.1, 0.2, 0.3}, 0.05));
  EXPECT_EQ(ball.type, Marker::SPHERE);
  EXPECT_DOUBLE_EQ(ball.scale.x, 0.1);
  EXPECT_TRUE(to_eigen(ball.pose).translation().isApprox(tilted() * Vector3d(0.1, 0.2, 0.3)));

  const Isometry3d place(Eigen::Translation3d(0.0, 0.1, 0.0));
  const Marker cylinder = marker_of(LinkPart::cylinder(place, 0.02, 0.3));
  EXPECT_EQ(cylinder.type, Marker::CYLINDER);
  EXPECT_NEAR(cylinder.scale.x, 0.04, 1e-5);
  EXPECT_NEAR(cylinder.scale.z, 0.3, 1e-5);
  const Vector3d end = tilted() * Vector3d(0.0, 0.1, 0.15);
  EXPECT_TRUE((to_eigen(cylinder.pose) * Vector3d(0, 0, 0.15)).isApprox(end, 1e-4));

  const Marker box = marker_of(LinkPart::box(Isometry3d::Identity(), {0.1, 0.2, 0.3}));
  EXPECT_EQ(box.type, Marker::CUBE);
  // The marker's axes may be those of the box in another order.
  const Vector3d size(box.scale.x, box.scale.y, box.scale.z);
  const Vector3d extent =
      (tilted().linear().transpose() * to_eigen(box.pose).linear() * size).cwiseAbs();
  EXPECT_TRUE(extent.isApprox(Vector3d(0.1, 0.2, 0.3), 1e-4)) << extent.transpose();
}

TEST(ToolMarkers, ALinkIsAMeshOrTheBoxOfALargeOne) {
  const std::vector<Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Marker mesh = marker_of(LinkPart::mesh({corners, {FaceIndices{0, 1, 2}}}));
  EXPECT_EQ(mesh.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(mesh.points.size(), 3u);
  EXPECT_TRUE(to_eigen(mesh.pose).isApprox(tilted(), 1e-12));
  const std::vector<FaceIndices> many(kMostFacesOfTool + 1, {0, 1, 2});
  EXPECT_EQ(marker_of(LinkPart::mesh({corners, many})).type, Marker::CUBE);
}

TEST(SweptMarkers, EachLegSweepsATriangleOrAQuadrangle) {
  const Marker marker =
      swept(kHook, {step(0.0, {{0.0, kBegin}, {0.5, kTurned}, {1.0, kMoved}})}, 0.1);
  ASSERT_EQ(marker.points.size(), 9u);
  EXPECT_EQ(marker.colors.size(), 9u);
  EXPECT_TRUE(swept(kHook, {step(0.0, {{0.0, kBegin}}), step(0.0, {})}, 0.0).points.empty());
  EXPECT_TRUE(swept(kHook, {step(0.0, {{0.0, kBegin}, {1.0, kBegin}})}, 0.0).points.empty());
}

TEST(SweptMarkers, TheTrailFadesAndIsCut) {
  const ToolPath turn{{0.0, kBegin}, {1.0, kTurned}};
  const Marker marker = swept(kHook, {step(-9.0, turn), step(0.0, turn), step(0.2, turn)}, 0.3);
  ASSERT_EQ(marker.colors.size(), 6u);  // Nothing is left of the first step.
  const float full = colours::kSwept.a;
  EXPECT_NEAR(marker.colors[0].a, full * (1.0 - 0.1 / kFadeSec), 1e-5);
  EXPECT_NEAR(marker.colors[3].a, full * (1.0 - 0.3 / kFadeSec), 1e-5);
  ToolPath path;
  for (int i = 0; i < 3000; ++i) path.push_back({i / 2999.0, i % 2 ? kBegin : kTurned});
  EXPECT_EQ(swept(kHook, {step(0.0, path)}, 0.0).points.size(), 3 * kMostLegs);
}

TEST(SweptMarkers, LinksSweepWithTheirLongestAxis) {
  Tool tool = grasper();
  tool.links = {{"jaw", {LinkPart::box(Isometry3d::Identity(), {0.01, 0.2, 0.02})}}};
  Isometry3d moved = Isometry3d::Identity();
  moved.translation().x() = 0.5;
  const Marker marker =
      swept(tool, {step(0.0, {{0.0, {}, {Isometry3d::Identity()}}, {1.0, {}, {moved}}})}, 0.0);
  ASSERT_EQ(marker.points.size(), 6u);
  double area = 0.0;
  for (std::size_t i = 0; i < 6; i += 3) {
    const Vector3d a = point(marker, i);
    area += 0.5 * (point(marker, i + 1) - a).cross(point(marker, i + 2) - a).norm();
  }
  EXPECT_NEAR(area, 0.5 * 0.2, 1e-6);
}

TEST(ProxyMarkers, AHeldProxyIsSolidAndASpringJoinsItsTranslucentHand) {
  const MarkerArray all = markers_of(held_hook());
  EXPECT_EQ(names_of(all), (std::set<std::string>{"proxy", "hand", "spring", "loads", "state"}));
  const Marker proxy = find_markers(all, "proxy").at(0), hand = find_markers(all, "hand").at(0);
  EXPECT_EQ(proxy.color.a, 1.0F);
  EXPECT_LT(hand.color.a, 1.0F);
  EXPECT_DOUBLE_EQ(proxy.scale.z, 0.295);
  EXPECT_DOUBLE_EQ(hand.scale.z, 0.315);
  const Marker spring = find_markers(all, "spring").at(0);
  EXPECT_TRUE(point(spring, 0).isApprox(Vector3d(0.1, 0.2, -0.015), 1e-12));
  EXPECT_TRUE(point(spring, 1).isApprox(Vector3d(0.1, 0.2, 0.005), 1e-12));
  EXPECT_EQ(spring.color, colours::proxy(ProxyStatus::kTouching));
  const Marker text = find_markers(all, "state").at(0);
  EXPECT_EQ(text.text, "hook: TOUCHING, 6.0 N");
  EXPECT_GT(text.pose.position.z, 0.3);  // Above the trocar.
  EXPECT_DOUBLE_EQ(text.pose.position.x, 0.1);
}

TEST(ProxyMarkers, AnArrowShowsEachLoadAndTheLongestOneTheGreatest) {
  ProxyView view = held_hook();
  ProxyContact other = view.answer.contacts.front();
  other.contact.point = {0.5, 0.2, 0.0};
  other.contact.normal = {1.0, 0.0, 0.0};
  other.load = 0.005;
  view.answer.contacts.push_back(other);
  view.answer.crossings = {{0, 7, {0.2, 0.3, 0.5}, 0.8, {0.1, 0.3, 0.0}, {0.0, 0.0, -0.01}}};
  const auto arrows = find_markers(markers_of(view), "loads");
  ASSERT_EQ(arrows.size(), 3u);
  const Vector3d tails[] = {{0.1, 0.2, 0.02}, {0.495, 0.2, 0.0}, {0.1, 0.3, 0.01}};
  const Vector3d heads[] = {{0.1, 0.2, 0.0}, {0.5, 0.2, 0.0}, {0.1, 0.3, 0.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(point(arrows[i], 0).isApprox(tails[i], 1e-12)) << i;
    EXPECT_TRUE(point(arrows[i], 1).isApprox(heads[i], 1e-12)) << i;
  }
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
  EXPECT_EQ(find_markers(all, "state").at(0).text, "hook: NO_ANSWER: there is no organ");
  EXPECT_EQ(find_markers(all, "state").at(0).color, colours::kFailure);
  view.hand.reset();
  EXPECT_EQ(names_of(markers_of(view)), (std::set<std::string>{"state"}));
}

TEST(ProxyMarkers, LinksHaveProxiesToo) {
  ProxyView view = held_hook();
  view.tool = grasper();
  const Isometry3d place(Eigen::Translation3d(0.0, 0.0, 0.1));
  view.hand = ToolPose{{Vector3d::Zero(), Vector3d::Zero()}, {place, place}};
  view.answer.proxy = *view.hand;
  EXPECT_EQ(find_markers(markers_of(view), "proxy").size(), 2u);
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
