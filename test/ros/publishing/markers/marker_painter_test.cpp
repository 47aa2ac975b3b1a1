#include "ros/publishing/markers/marker_painter.hpp"

#include <gtest/gtest.h>

#include <set>

#include "ros/publishing/markers/surface_markers.hpp"
#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

/// A viewer: keeps the markers as RViz does.
class Painter : public testing::Test {
 protected:
  /// Paints, and returns the number of surface markers that came.
  std::size_t paint(const Scene& scene) {
    std::size_t surfaces = 0;
    painter_.paint(scene, [&](const visualization_msgs::MarkerArrayConstPtr& array) {
      EXPECT_FALSE(array->markers.empty());
      for (const Marker& marker : array->markers) {
        EXPECT_FALSE(marker.header.frame_id.empty()) << marker.ns;
        if (marker.action == Marker::DELETEALL) shown_.clear();
        if (marker.action == Marker::DELETE) {
          EXPECT_EQ(shown_.erase({marker.ns, marker.id}), 1u);
        }
        if (marker.action != Marker::ADD) continue;
        EXPECT_GT(marker.lifetime.toSec(), kRefreshSec);
        shown_.insert({marker.ns, marker.id});
        surfaces += marker.ns.rfind("surface/", 0) == 0;
      }
    });
    return surfaces;
  }

  std::set<std::string> namespaces() const {
    std::set<std::string> names;
    for (const auto& [name, id] : shown_) names.insert(name);
    return names;
  }

  /// A scene with a step in which the hook moves and touches.
  Scene touching(double seconds) {
    Scene scene = hook_over_square(seconds);
    scene.organs = {organ_};
    const auto answer = answer_with({contact_at(0, 0.001, 0.2, 0.2)});
    const ToolPath path{{0.0, {{0, 0, 1}, {0, 0, 0}}}, {1.0, {{0, 0, 1}, {1, 0, 0}}}};
    scene.steps = {{scene.time, answer, organ_.faces, path, 42e-6}};
    scene.pairs[0].answer = answer;
    return scene;
  }

  /// A scene without steps, in which nothing is touched.
  Scene resting(double seconds) {
    Scene scene = hook_over_square(seconds);
    scene.organs = {organ_};
    scene.pairs[0].answer = answer_with({});
    return scene;
  }

  SceneOrgan organ_ = square();
  MarkerPainter painter_;
  std::set<std::pair<std::string, int>> shown_;
};

}  // namespace

TEST_F(Painter, ShowsTheWholeScene) {
  paint(touching(0.0));
  EXPECT_EQ(namespaces(), (std::set<std::string>{"surface/liver", "tools", "swept", "touched",
                                                 "normals", "names", "status"}));
}

TEST_F(Painter, WhatIsNearAndCrossedIsShownAsLongAsTheLatestAnswerHasIt) {
  Scene scene = resting(0.0);
  const auto answer = answer_with({});
  answer->clearance.state = Clearance::KNOWN;
  answer->clearance.margin = 0.05;
  answer->clearance.normal.z = -1.0;
  answer->near = {contact_at(1, -0.01, 0.3, 0.3)};
  answer->placement.crossings.resize(1);
  scene.pairs[0].answer = answer;
  paint(scene);
  EXPECT_EQ(namespaces(), (std::set<std::string>{"surface/liver", "tools", "near", "clearance",
                                                 "crossings", "status"}));
  paint(resting(0.01));
  EXPECT_EQ(namespaces(), (std::set<std::string>{"surface/liver", "tools", "status"}));
}

TEST_F(Painter, TracesVanishAfterTheContact) {
  paint(touching(0.0));
  paint(resting(0.1));
  EXPECT_EQ(namespaces().count("touched"), 1u);  // It fades.
  paint(resting(5.0));
  EXPECT_EQ(namespaces(), (std::set<std::string>{"surface/liver", "tools", "status"}));
}

TEST_F(Painter, AContactLastsAsLongAsTheLatestAnswerHasIt) {
  paint(touching(0.0));
  Scene scene = touching(5.0);
  scene.steps.clear();
  paint(scene);
  EXPECT_EQ(namespaces().count("touched"), 1u);
  EXPECT_EQ(namespaces().count("normals"), 1u);
  EXPECT_EQ(namespaces().count("swept"), 0u);
}

TEST_F(Painter, NothingIsLeftOfAnOrganThatIsGone) {
  Scene scene = touching(0.0);
  scene.organs.push_back(square("kidney"));
  paint(scene);
  paint(touching(0.1));
  EXPECT_EQ(namespaces().count("surface/kidney"), 0u);
  EXPECT_EQ(namespaces().count("surface/liver"), 1u);
  Scene empty;
  empty.time = at(0.2);
  empty.tools = std::make_shared<std::vector<Tool>>();
  paint(empty);
  EXPECT_TRUE(shown_.empty());
}

TEST_F(Painter, NothingIsLeftOfAToolThatIsGone) {
  paint(touching(0.0));
  Scene scene = resting(5.0);
  scene.pairs.clear();
  paint(scene);
  EXPECT_EQ(namespaces(), (std::set<std::string>{"surface/liver", "status"}));
}

TEST_F(Painter, ANewSubscriberGetsTheWholeScene) {
  paint(touching(0.0));
  shown_.insert({"of an earlier run", 7});
  Scene scene = resting(0.01);
  scene.anew = true;
  EXPECT_EQ(paint(scene), 1u);
  EXPECT_EQ(namespaces().count("of an earlier run"), 0u);
  EXPECT_EQ(namespaces().count("surface/liver"), 1u);
}

TEST_F(Painter, ASurfaceThatRestsIsSentSeldom) {
  EXPECT_EQ(paint(resting(0.0)), 1u);
  EXPECT_EQ(paint(resting(0.5)), 0u);
  EXPECT_EQ(paint(resting(1.1 * kRefreshSec)), 1u);
}

TEST_F(Painter, ASurfaceThatMovesIsSentAtItsRate) {
  std::size_t sent = 0;
  for (int i = 0; i < 100; ++i) {
    Scene scene = resting(0.01 * i);
    scene.settings.surface_rate_hz = 20.0;
    scene.organs[0].vertices = std::make_shared<std::vector<float>>(*organ_.vertices);
    sent += paint(scene);
  }
  EXPECT_GE(sent, 17u);
  EXPECT_LE(sent, 20u);
}

TEST_F(Painter, ALargeSurfaceIsSentLessOften) {
  organ_.faces = std::make_shared<std::vector<FaceIndices>>(
      static_cast<std::size_t>(kFacesPerSecond / 10), FaceIndices{0, 1, 2});
  std::size_t sent = 0;
  for (int i = 0; i < 100; ++i) {
    Scene scene = resting(0.01 * i);
    scene.organs[0].vertices = std::make_shared<std::vector<float>>(*organ_.vertices);
    sent += paint(scene);
  }
  EXPECT_GE(sent, 9 * surface_marker_count(organ_));
  EXPECT_LE(sent, 10 * surface_marker_count(organ_));
}

TEST_F(Painter, ASmallerSurfaceLeavesNoScraps) {
  organ_.faces =
      std::make_shared<std::vector<FaceIndices>>(3 * kFacesPerMarker, FaceIndices{0, 1, 2});
  EXPECT_EQ(paint(resting(0.0)), 3u);
  organ_ = square();
  EXPECT_EQ(paint(resting(1.0)), 1u);
  EXPECT_EQ(shown_.count({"surface/liver", 0}), 1u);
  EXPECT_EQ(shown_.count({"surface/liver", 1}), 0u);
}

TEST_F(Painter, SurfacesCanBeTurnedOff) {
  paint(resting(0.0));
  Scene scene = resting(0.1);
  scene.settings.surface_rate_hz = 0.0;
  paint(scene);
  EXPECT_EQ(namespaces(), (std::set<std::string>{"tools", "status"}));
}

TEST_F(Painter, StepsOfEarlierTrianglesLeaveNoTraces) {
  Scene scene = touching(0.0);
  scene.steps[0].faces = square().faces;
  scene.pairs[0].answer = nullptr;
  paint(scene);
  EXPECT_EQ(namespaces(), (std::set<std::string>{"surface/liver", "tools", "status"}));
}

TEST_F(Painter, AProxyNeedsNoOrgan) {
  Scene scene;
  scene.time = at(0.0);
  scene.anew = true;
  scene.tools = std::make_shared<std::vector<Tool>>();
  scene.proxies.resize(1);
  scene.proxies[0].tool = shaft_tool("hook", 0.25);
  scene.proxies[0].frame = "room";
  scene.proxies[0].answer.state = ProxyStatus::kFree;
  scene.proxies[0].answer.proxy = ToolPose{{{0.0, 0.0, 2.0}, {0.0, 4.0, 2.0}}, {}};
  paint(scene);
  EXPECT_EQ(namespaces(), (std::set<std::string>{"proxy", "state"}));
  scene.proxies.clear();
  scene.anew = false;
  paint(scene);
  EXPECT_EQ(namespaces(), (std::set<std::string>{}));
}
