#include "ros/publishing/markers/proxy_markers.hpp"

#include <gtest/gtest.h>

#include <set>

#include "ros/publishing/markers/colours.hpp"
#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using Eigen::Vector3d;
using visualization_msgs::Marker;
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
