#include "ros/markers/marker_painter.hpp"

#include <gtest/gtest.h>

#include <set>

#include "hand_made_scenes.hpp"
#include "ros/markers/scene.hpp"

using namespace organ_collision;

namespace {

const ToolPose kPose{{{0.0, 0.0, 2.0}, {0.0, 4.0, 2.0}}, {}};

}  // namespace

TEST(Scene, FindsOrgansByName) {
  Scene scene;
  scene.organs = {square("kidney"), square("liver")};
  ASSERT_TRUE(scene.organ("liver"));
  EXPECT_EQ(scene.organ("liver")->frame, "liver_frame");
  EXPECT_FALSE(scene.organ("spleen"));
}

TEST(Scene, AToolIsPlacedByTheFirstOrganThatKnowsItsPose) {
  Scene scene;
  scene.organs = {square("kidney"), square("liver")};
  scene.pairs = {{"gone", 0, nullptr, kPose},
                 {"kidney", 0, nullptr, std::nullopt},
                 {"kidney", 1, nullptr, kPose},
                 {"liver", 0, nullptr, kPose}};
  ASSERT_TRUE(scene.placement(0));
  EXPECT_EQ(scene.placement(0)->organ, "liver");
  EXPECT_EQ(scene.placement(1)->organ, "kidney");
  EXPECT_FALSE(scene.placement(2));
}

TEST(Scene, OrganHasItsTrianglesAndSize) {
  const SceneOrgan organ = square();
  EXPECT_EQ(organ.triangle(1)[1], Eigen::Vector3d(1.0, 1.0, 0.0));
  EXPECT_NEAR(organ.size(), std::sqrt(2.0), 1e-6);
}

using namespace organ_collision;
using visualization_msgs::Marker;

TEST(SurfaceMarkers, ShowEachFace) {
  const SceneOrgan organ = square();
  ASSERT_EQ(surface_marker_count(organ), 1u);
  const Marker surface = surface_marker(organ, 0, 0);
  EXPECT_EQ(surface.ns, "surface/liver");
  EXPECT_EQ(surface.header.frame_id, "liver_frame");
  EXPECT_EQ(surface.type, Marker::TRIANGLE_LIST);
  ASSERT_EQ(surface.points.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(point(surface, i), organ.triangle(i / 3)[i % 3]) << i;
  }
}

TEST(SurfaceMarkers, ALargeSurfaceIsCutIntoSeveral) {
  SceneOrgan organ = square();
  organ.faces =
      std::make_shared<std::vector<FaceIndices>>(2 * kFacesPerMarker + 5, FaceIndices{0, 1, 2});
  ASSERT_EQ(surface_marker_count(organ), 3u);
  EXPECT_EQ(surface_marker(organ, 0, 1).points.size(), 3 * kFacesPerMarker);
  EXPECT_EQ(surface_marker(organ, 0, 2).points.size(), 15u);
  EXPECT_EQ(surface_marker(organ, 0, 2).id, 2);
  organ.faces = std::make_shared<std::vector<FaceIndices>>(kFacesPerMarker, FaceIndices{0, 1, 2});
  EXPECT_EQ(surface_marker_count(organ), 1u);
}

using namespace organ_collision;

TEST(ShownMarkers, DeletesWhatIsNoLongerThere) {
  ShownMarkers shown;
  visualization_msgs::MarkerArray array;
  shown.replace({{"names", {3, "liver"}}, {"tools", {1, "kidney"}}}, array);
  EXPECT_TRUE(array.markers.empty());
  shown.replace({{"names", {1, "spleen"}}}, array);
  ASSERT_EQ(array.markers.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(array.markers[i].action, Marker::DELETE);
  EXPECT_EQ(array.markers[0].ns, "names");
  EXPECT_EQ(array.markers[0].id, 1);
  EXPECT_EQ(array.markers[0].header.frame_id, "liver");
  EXPECT_EQ(array.markers[1].id, 2);
  EXPECT_EQ(array.markers[2].ns, "tools");
  EXPECT_EQ(array.markers[2].header.frame_id, "kidney");
}

TEST(ShownMarkers, DeletesNothingTwice) {
  ShownMarkers shown;
  visualization_msgs::MarkerArray array, again;
  shown.replace({{"names", {3, "liver"}}}, array);
  shown.replace({}, array);
  EXPECT_EQ(array.markers.size(), 3u);
  shown.replace({}, again);
  EXPECT_TRUE(again.markers.empty());
}

TEST(ShownMarkers, NothingIsDeletedAfterClear) {
  ShownMarkers shown;
  visualization_msgs::MarkerArray array;
  shown.replace({{"names", {3, "liver"}}}, array);
  shown.clear();
  shown.replace({}, array);
  EXPECT_TRUE(array.markers.empty());
}

using namespace organ_collision;

TEST(SecondMean, ChangesOnceASecond) {
  SecondMean mean;
  EXPECT_EQ(mean.at(at(0.0)), 0.0);
  mean.add(2.0);
  EXPECT_EQ(mean.at(at(0.1)), 2.0);
  mean.add(5.0);
  mean.add(9.0);
  EXPECT_EQ(mean.at(at(1.0)), 2.0);
  EXPECT_EQ(mean.at(at(1.2)), 7.0);
  EXPECT_EQ(mean.at(at(9.0)), 7.0);
}

using namespace organ_collision;
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
