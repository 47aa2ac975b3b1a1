#include "haptics/proxy_markers.hpp"

#include <gtest/gtest.h>

#include <set>

#include "common/messages/conversions.hpp"
#include "test/node/tools/hand_made_tools.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

namespace {

using Names = std::set<std::string>;

struct Picture : visualization_msgs::MarkerArray {
  Names namespaces() const {
    Names names;
    for (const Marker& marker : markers) names.insert(marker.ns);
    return names;
  }
  std::vector<Marker> of(const std::string& name_space) const {
    std::vector<Marker> found;
    for (const Marker& marker : markers) {
      if (marker.ns == name_space) found.push_back(marker);
    }
    return found;
  }
};

Picture drawn(const ProxyView& view) {
  Picture picture;
  add_proxy(view, picture);
  return picture;
}

Vector3d point(const Marker& marker, std::size_t index) {
  return to_eigen(marker.points.at(index));
}

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
  ProxyFace contact;
  contact.contact.point = {0.1, 0.2, 0.0};
  contact.contact.normal = {0.0, 0.0, -1.0};
  contact.load = 0.02;
  view.answer.contacts = {contact};
  view.force = 6.04;
  view.size = 0.2;
  return view;
}

}  // namespace

TEST(ProxyMarkers, ShowAHeldProxySolidAndASpringToItsTranslucentHand) {
  const Picture picture = drawn(held_hook());
  const Marker proxy = picture.of("proxy").at(0), hand = picture.of("hand").at(0);
  EXPECT_EQ(picture.namespaces(), (Names{"proxy", "hand", "spring", "loads", "state"}));
  EXPECT_EQ(proxy.color.a, 1.0F);
  EXPECT_LT(hand.color.a, 1.0F);
  EXPECT_DOUBLE_EQ(proxy.scale.z, 0.295);
  EXPECT_DOUBLE_EQ(hand.scale.z, 0.315);
  const Marker spring = picture.of("spring").at(0);
  EXPECT_TRUE(point(spring, 0).isApprox(Vector3d(0.1, 0.2, -0.015), 1e-12));
  EXPECT_TRUE(point(spring, 1).isApprox(Vector3d(0.1, 0.2, 0.005), 1e-12));
  EXPECT_EQ(spring.color, colour_of(ProxyStatus::kTouching));
  const Marker text = picture.of("state").at(0);
  EXPECT_EQ(text.text, "hook: TOUCHING, 6.0 N");
  EXPECT_GT(text.pose.position.z, 0.3);  // Above the trocar.
  EXPECT_DOUBLE_EQ(text.pose.position.x, 0.1);
}

TEST(ProxyMarkers, ShowNoHandOfAFreeProxyAndNoProxyWithoutAnAnswer) {
  ProxyView view = held_hook();
  view.answer.state = ProxyStatus::kFree;
  view.answer.proxy = *view.hand;
  view.answer.pull.setZero();
  view.answer.contacts.front().load = 0.0;
  EXPECT_EQ(drawn(view).namespaces(), (Names{"proxy", "state"}));
  view.tool = grasper();
  const Isometry3d place(Eigen::Translation3d(0.0, 0.0, 0.1));
  view.hand = view.answer.proxy = {{Vector3d::Zero(), Vector3d::Zero()}, {place, place}};
  EXPECT_EQ(drawn(view).of("proxy").size(), 2u);

  view = held_hook();
  view.answer.state = ProxyStatus::kNoAnswer;
  view.answer.message = "there is no organ";
  const Marker state = drawn(view).of("state").at(0);
  EXPECT_EQ(drawn(view).namespaces(), (Names{"hand", "state"}));
  EXPECT_EQ(state.text, "hook: NO_ANSWER: there is no organ");
  EXPECT_EQ(state.color, colours::kFailure);
  view.hand.reset();
  EXPECT_EQ(drawn(view).namespaces(), (Names{"state"}));
}
