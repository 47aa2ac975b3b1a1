#include "ros/markers/marker_painter.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "test/ros/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

using Names = std::set<std::string>;

std::shared_ptr<const TriangleMesh> mesh_of(std::size_t faces) {
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < faces; ++i) corners.insert(corners.end(), {0, 1, 2});
  return std::make_shared<const TriangleMesh>(
      TriangleMesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, corners));
}

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
          EXPECT_EQ(shown_.erase({marker.ns, marker.id}), 1u) << marker.ns << marker.id;
        }
        if (marker.action != Marker::ADD) continue;
        EXPECT_GT(marker.lifetime.toSec(), kRefreshSec);
        shown_[{marker.ns, marker.id}] = marker;
        surfaces += marker.ns.rfind("surface/", 0) == 0;
      }
    });
    return surfaces;
  }

  Names namespaces() const {
    Names names;
    for (const auto& [name, marker] : shown_) names.insert(name.first);
    return names;
  }

  const Marker& touched() { return shown_.at({"touched", 0}); }

  /// A scene without steps, in which nothing is touched.
  Scene resting(double seconds) {
    Scene scene = hook_over_square(seconds);
    scene.organs = {organ_};
    scene.pairs[0].answer = answer_with({});
    return scene;
  }

  /// A scene with a step in which the hook moves and touches.
  Scene touching(double seconds, double depth = 0.004) {
    Scene scene = resting(seconds);
    const auto answer = answer_with({contact_at(1, depth, 0.7, 0.7)});
    const ToolPath path{{0.0, {{0, 0, 1}, {0, 0, 0}}}, {1.0, {{0, 0, 1}, {1, 0, 0}}}};
    scene.steps = {{scene.time, answer, organ_.mesh->shared_faces(), path, 42e-6}};
    scene.pairs[0].answer = answer;
    return scene;
  }

  SceneOrgan organ_ = square();
  MarkerPainter painter_;
  std::map<std::pair<std::string, int>, Marker> shown_;
};

}  // namespace

TEST_F(Painter, ShowsTheWholeScene) {
  EXPECT_EQ(paint(touching(0.0)), 1u);
  EXPECT_EQ(namespaces(),
            (Names{"surface/liver", "tools", "swept", "touched", "normals", "names", "status"}));
  const Marker& surface = shown_.at({"surface/liver", 0});
  EXPECT_EQ(surface.header.frame_id, "liver_frame");
  EXPECT_EQ(surface.type, Marker::TRIANGLE_LIST);
  ASSERT_EQ(surface.points.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(point(surface, i), organ_.mesh->triangle(i / 3)[i % 3]) << i;
  }
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
  EXPECT_EQ(namespaces(),
            (Names{"surface/liver", "tools", "near", "clearance", "crossings", "status"}));
  paint(resting(0.01));
  EXPECT_EQ(namespaces(), (Names{"surface/liver", "tools", "status"}));
}

TEST_F(Painter, TouchedFacesAreColouredByDepthAndFadeAfterTheContact) {
  paint(touching(0.0));
  ASSERT_EQ(touched().points.size(), 6u);                  // Both sides of the face.
  EXPECT_EQ(touched().colors.at(0), colours::depth(0.4));  // Of 10 mm.
  paint(resting(0.1));
  EXPECT_NEAR(touched().colors.at(0).a, 1.0 - 0.1 / kFadeSec, 1e-5);
  EXPECT_EQ(namespaces().count("normals"), 1u);
  paint(resting(5.0));
  EXPECT_EQ(namespaces(), (Names{"surface/liver", "tools", "status"}));
  Scene scene = touching(9.0);
  scene.steps.clear();
  paint(scene);  // The latest answer still has the contact.
  EXPECT_EQ(namespaces(),
            (Names{"surface/liver", "tools", "touched", "normals", "names", "status"}));
}

TEST_F(Painter, TheDeeperOfTwoToolsColoursAFace) {
  Scene scene = touching(0.0, 0.006);
  scene.pairs.push_back(scene.pairs[0]);
  scene.pairs.back().answer = answer_with({contact_at(1, 0.002, 0.7, 0.7)});
  paint(scene);
  EXPECT_EQ(touched().colors.at(0), colours::depth(0.6));
  paint(touching(0.1, 0.002));
  EXPECT_EQ(touched().colors.at(0), colours::depth(0.2));
}

TEST_F(Painter, StepsOfEarlierTrianglesLeaveNoTraces) {
  paint(touching(0.0));
  organ_ = square();
  Scene scene = resting(0.1);
  scene.pairs[0].answer = nullptr;
  paint(scene);
  EXPECT_EQ(namespaces(), (Names{"surface/liver", "tools", "swept", "status"}));
}

TEST_F(Painter, NothingIsLeftOfWhatIsGone) {
  Scene scene = touching(0.0);
  scene.organs.push_back(square("kidney"));
  paint(scene);
  paint(touching(0.1));
  EXPECT_EQ(namespaces().count("surface/kidney"), 0u);
  EXPECT_EQ(namespaces().count("surface/liver"), 1u);
  scene = resting(5.0);
  scene.pairs.clear();
  paint(scene);
  EXPECT_EQ(namespaces(), (Names{"surface/liver", "status"}));
  Scene empty;
  empty.time = at(5.1);
  empty.tools = std::make_shared<std::vector<Tool>>();
  paint(empty);
  EXPECT_TRUE(shown_.empty());
  paint(resting(5.2));
  EXPECT_EQ(namespaces().count("surface/liver"), 1u);
}

TEST_F(Painter, ANewSubscriberGetsTheWholeScene) {
  paint(touching(0.0));
  shown_[{"of an earlier run", 7}] = {};
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
  Scene scene = resting(9.0);
  scene.settings.surface_rate_hz = 0.0;  // Switched off.
  paint(scene);
  EXPECT_EQ(namespaces(), (Names{"tools", "status"}));
}

TEST_F(Painter, ASurfaceThatMovesIsSentAtItsRateAndALargeOneLessOften) {
  for (const std::size_t faces : {std::size_t{2}, static_cast<std::size_t>(kFacesPerSecond / 10)}) {
    painter_ = MarkerPainter();
    std::size_t sent = 0;
    const auto mesh = mesh_of(faces);
    for (int i = 0; i < 100; ++i) {
      organ_.mesh = std::make_shared<const TriangleMesh>(*mesh);
      Scene scene = resting(0.01 * i);
      scene.settings.surface_rate_hz = 20.0;
      sent += paint(scene);
    }
    const std::size_t markers = (faces + kFacesPerMarker - 1) / kFacesPerMarker;
    EXPECT_GE(sent, (faces > 2 ? 9 : 17) * markers);
    EXPECT_LE(sent, (faces > 2 ? 10 : 20) * markers);
    shown_.clear();
  }
}

TEST_F(Painter, ALargeSurfaceIsCutAndASmallerOneLeavesNoScraps) {
  organ_.mesh = mesh_of(2 * kFacesPerMarker + 5);
  EXPECT_EQ(paint(resting(0.0)), 3u);
  EXPECT_EQ(shown_.at({"surface/liver", 1}).points.size(), 3 * kFacesPerMarker);
  EXPECT_EQ(shown_.at({"surface/liver", 2}).points.size(), 15u);
  organ_.mesh = mesh_of(kFacesPerMarker);
  EXPECT_EQ(paint(resting(1.0)), 1u);
  EXPECT_EQ(shown_.count({"surface/liver", 0}), 1u);
  EXPECT_EQ(shown_.count({"surface/liver", 1}), 0u);
}

TEST_F(Painter, TheTimeOfAQueryChangesOnceASecond) {
  const auto shown_at = [&](double seconds, double query_sec) {
    Scene scene = touching(seconds);
    scene.steps[0].query_sec = query_sec;
    paint(scene);
    const std::string& text = shown_.at({"status", 0}).text;
    return text.substr(text.rfind('\n') + 1);
  };
  EXPECT_EQ(shown_at(0.0, 2e-6), "2 us a query");
  EXPECT_EQ(shown_at(0.1, 5e-6), "2 us a query");
  EXPECT_EQ(shown_at(1.2, 9e-6), "7 us a query");
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
  EXPECT_EQ(namespaces(), (Names{"proxy", "state"}));
  scene.proxies.clear();
  scene.anew = false;
  paint(scene);
  EXPECT_TRUE(shown_.empty());
}

TEST(Scene, AToolIsPlacedByTheFirstOrganThatKnowsItsPose) {
  const ToolPose pose{{{0.0, 0.0, 2.0}, {0.0, 4.0, 2.0}}, {}};
  Scene scene;
  scene.organs = {square("kidney"), square("liver")};
  scene.pairs = {{"gone", 0, nullptr, pose},
                 {"kidney", 0, nullptr, std::nullopt},
                 {"kidney", 1, nullptr, pose},
                 {"liver", 0, nullptr, pose}};
  ASSERT_TRUE(scene.placement(0));
  EXPECT_EQ(scene.placement(0)->organ, "liver");
  EXPECT_EQ(scene.placement(1)->organ, "kidney");
  EXPECT_FALSE(scene.placement(2));
}
