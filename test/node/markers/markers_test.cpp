#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "common/messages/conversions.hpp"
#include "node/markers/marker_publisher.hpp"
#include "test/node/tools/hand_made_tools.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

namespace {

using Names = std::set<std::string>;
using Markers = std::vector<Marker>;

const ShaftAxis kAxis{{0.3, 0.4, 1.0}, {0.9, 0.4, -0.2}};

/// A square of two faces in the plane z = 0, from (0, 0) to (1, 1) [m].
SceneOrgan square(const std::string& name = "liver") {
  return {name, name + "_frame",
          std::make_shared<const TriangleMesh>(
              TriangleMesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, {0, 1, 2, 1, 3, 2}))};
}
const double kSize = std::sqrt(2.0);

std::shared_ptr<const TriangleMesh> mesh_of(std::size_t faces) {
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < faces; ++i) corners.insert(corners.end(), {0, 1, 2});
  return std::make_shared<const TriangleMesh>(
      TriangleMesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, corners));
}

/// A contact in the plane z = 0, whose tool is above.
Contact contact_at(std::uint32_t face, double depth, double x, double y) {
  Contact contact;
  contact.face = face;
  contact.depth = depth;
  contact.link = kShaft;
  contact.normal.z = -1.0;
  contact.on_organ.x = x;
  contact.on_organ.y = y;
  return contact;
}

/// An answer about the square and the tool "hook".
ContactArrayPtr answer_with(const std::vector<Contact>& contacts) {
  const auto answer = boost::make_shared<ContactArray>();
  answer->organ = "liver";
  answer->tool = "hook";
  answer->contacts = contacts;
  return answer;
}

/// The hook is 32 mm from the square, along an oblique line.
ContactArrayPtr answer_near() {
  const auto answer = answer_with({});
  Clearance& clearance = answer->clearance;
  clearance.state = Clearance::KNOWN;
  clearance.margin = 0.05;
  clearance.distance = 0.032;
  const Vector3d normal(0.6, 0.0, -0.8), on_organ(0.25, 0.5, 0.0);
  clearance.normal = to_vector(normal);
  clearance.on_organ = tf2::toMsg(on_organ);
  clearance.on_tool = tf2::toMsg(Vector3d(on_organ - 0.032 * normal));
  return answer;
}

/// A time later than the clock's zero.
SteadyTime at(double seconds) {
  return SteadyTime() + std::chrono::duration_cast<SteadyTime::duration>(
                            std::chrono::duration<double>(1000.0 + seconds));
}

/// A square and a hook that rests across it.
Scene scene_with(const ContactArrayConstPtr& answer, double seconds = 0.0,
                 const SceneOrgan& organ = square()) {
  Scene scene;
  scene.time = at(seconds);
  scene.tools = std::make_shared<std::vector<Tool>>(1, shaft_tool("hook", 0.02));
  scene.organs = {organ};
  scene.organs[0].pairs = {{0, answer, ToolPose{kAxis, {}}}};
  return scene;
}

/// A scene of one tool without an answer.
Scene scene_of(const Tool& tool, const ToolPose& pose) {
  Scene scene = scene_with(nullptr);
  scene.tools = std::make_shared<std::vector<Tool>>(1, tool);
  scene.organs[0].pairs[0].pose = pose;
  return scene;
}

Vector3d point(const Marker& marker, std::size_t index) {
  return to_eigen(marker.points.at(index));
}

/// What a reader sees: the texts of the markers, a line each.
std::string text_of(const Markers& markers) {
  std::string text;
  for (const Marker& marker : markers) text += (text.empty() ? "" : "\n") + marker.text;
  return text;
}

/// Keeps the markers as RViz does.
class Viewer : public testing::Test {
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
        check(marker);
        shown_[{marker.ns, marker.id}] = marker;
        surfaces += marker.ns.rfind("surface/", 0) == 0;
      }
    });
    return surfaces;
  }

  /// What RViz demands of any marker.
  static void check(const Marker& marker) {
    SCOPED_TRACE(marker.ns);
    EXPECT_GT(marker.lifetime.toSec(), kRefreshSec);
    EXPECT_TRUE(marker.frame_locked && marker.header.stamp.isZero());
    EXPECT_TRUE(is_unit(marker.pose.orientation));
    EXPECT_GT(std::min({marker.scale.x, marker.scale.y, marker.scale.z}), 0.0);
    EXPECT_TRUE(marker.colors.empty() || marker.colors.size() == marker.points.size());
    const bool has_points = marker.type == Marker::TRIANGLE_LIST ||
                            marker.type == Marker::LINE_LIST || marker.type == Marker::ARROW;
    EXPECT_EQ(marker.points.empty(), !has_points);
    for (const auto& point : marker.points) EXPECT_TRUE(to_eigen(point).allFinite());
    if (marker.type == Marker::ARROW) {
      EXPECT_GT((point(marker, 1) - point(marker, 0)).norm(), 0.0);
    }
  }

  Names namespaces() const {
    Names names;
    for (const auto& [name, marker] : shown_) names.insert(name.first);
    return names;
  }

  /// The markers of a namespace, numbered from 0.
  Markers shown(const std::string& name_space) const {
    Markers found;
    for (const auto& [name, marker] : shown_) {
      if (name.first == name_space) found.push_back(marker);
    }
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].id, static_cast<int>(i));
    return found;
  }
  /// The same when a new node paints a scene for a new viewer.
  Markers drawn(const Scene& scene, const std::string& name_space) {
    painter_ = MarkerPainter();
    shown_.clear();
    paint(scene);
    return shown(name_space);
  }

  MarkerPainter painter_;
  std::map<std::pair<std::string, int>, Marker> shown_;
};

/// The same organ in a sequence of scenes, in which nothing is touched.
class Painter : public Viewer {
 protected:
  Scene resting(double seconds) { return scene_with(answer_with({}), seconds, organ_); }

  SceneOrgan organ_ = square();
};

/// A step in which the hook turns about its trocar.
SceneStep turn(const ContactArrayConstPtr& answer) {
  return {answer, {{0.0, {{0, 0, 1}, {0, 0, 0}}}, {1.0, {{0, 0, 1}, {1, 0, 0}}}}};
}

}  // namespace

TEST_F(Viewer, SeesTheWholeScene) {
  Scene scene = scene_with(answer_with({contact_at(1, 0.004, 0.7, 0.7)}));
  scene.organs[0].pairs[0].steps = {turn(answer_with({contact_at(1, 0.006, 0.7, 0.7)}))};
  DurationStatistics times;
  times.add(42e-6);
  scene.query_times = &times;
  EXPECT_EQ(paint(scene), 1u);
  EXPECT_EQ(namespaces(),
            (Names{"surface/liver", "tools", "swept", "touched", "normals", "names", "status"}));
  const Marker surface = shown("surface/liver").at(0), touched = shown("touched").at(0);
  EXPECT_EQ(surface.header.frame_id, "liver_frame");
  EXPECT_EQ(surface.type, Marker::TRIANGLE_LIST);
  ASSERT_EQ(surface.points.size(), 6u);
  ASSERT_EQ(touched.points.size(), 6u);  // Both sides of the face.
  const TriangleMesh& mesh = *scene.organs[0].mesh;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(point(surface, i), mesh.triangle(i / 3)[i % 3]) << i;
    const Vector3d lift = point(touched, i) - mesh.triangle(1)[i % 3];
    EXPECT_LT((lift - Vector3d(0, 0, (i < 3 ? 1e-3 : -1e-3) * kSize)).norm(), 1e-7);
  }
  EXPECT_EQ(touched.colors.at(0), colours::depth(0.6)) << "of 10 mm, the deepest contact counts";
  EXPECT_EQ(shown("swept").at(0).points.size(), 3u) << "what has no area is left out";
  EXPECT_EQ(text_of(shown("status")),
            "liver: 2 faces\nhook: 1 contact, 4.0 mm deep\n0.042 ms a query");
}

TEST_F(Painter, WhatIsGoneIsDeletedAndANewSubscriberGetsTheWholeScene) {
  Scene scene = scene_with(answer_with({contact_at(1, 0.004, 0.7, 0.7)}));
  scene.organs.push_back(square("kidney"));
  paint(scene);
  EXPECT_NE(shown("surface/liver").at(0).color, shown("surface/kidney").at(0).color);
  paint(resting(0.1));
  EXPECT_EQ(namespaces(), (Names{"surface/liver", "tools", "status"}));
  shown_[{"of an earlier run", 7}] = {};
  scene = resting(0.2);
  scene.anew = true;
  EXPECT_EQ(paint(scene), 1u);
  EXPECT_EQ(namespaces(), (Names{"surface/liver", "tools", "status"}));
  scene = resting(0.3);
  scene.settings.surface_rate_hz = 0.0;  // Switched off.
  paint(scene);
  EXPECT_EQ(namespaces(), (Names{"tools", "status"}));
  scene.organs.clear();
  paint(scene);
  EXPECT_TRUE(shown_.empty());
}

TEST_F(Painter, ASurfaceIsSentAtItsRateALargeOneLessOftenAndARestingOneSeldom) {
  EXPECT_EQ(paint(resting(0.0)), 1u);
  EXPECT_EQ(paint(resting(0.5)), 0u);
  EXPECT_EQ(paint(resting(1.1 * kRefreshSec)), 1u);
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
  EXPECT_EQ(shown("surface/liver").at(1).points.size(), 3 * kFacesPerMarker);
  EXPECT_EQ(shown("surface/liver").at(2).points.size(), 15u);
  organ_.mesh = mesh_of(kFacesPerMarker);
  EXPECT_EQ(paint(resting(1.0)), 1u);
  EXPECT_EQ(shown("surface/liver").size(), 1u);
}

TEST_F(Viewer, SeesDepthsThatGetDarkerAndAreClamped) {
  const auto brightness = [](const std_msgs::ColorRGBA& colour) {
    return 0.3 * colour.r + 0.6 * colour.g + 0.1 * colour.b;
  };
  for (int i = 0; i < 100; ++i) {
    const auto shallow = colours::depth(0.01 * i), deep = colours::depth(0.01 * (i + 1));
    EXPECT_GT(brightness(shallow), brightness(deep)) << i;
    EXPECT_EQ(shallow.a, 1.0f);
  }
  EXPECT_EQ(colours::depth(-3.0), colours::depth(0.0));
  EXPECT_EQ(colours::depth(std::numeric_limits<double>::infinity()), colours::depth(1.0));
  // A face without an area has no normal.
  SceneOrgan organ = square();
  organ.mesh =
      std::make_shared<const TriangleMesh>(TriangleMesh({0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2}));
  EXPECT_EQ(drawn(scene_with(answer_with({contact_at(0, 0, 0, 0)}), 0.0, organ), "touched").size(),
            1u);
}

TEST_F(Viewer, SeesOutlinesAndTheDeepestContactsAsArrows) {
  const auto answer = answer_with({contact_at(0, 0.1, 0.25, 0.5)});
  answer->regions.resize(2);
  answer->regions[1].points.resize(4);
  EXPECT_EQ(drawn(scene_with(answer), "regions").at(0).points.size(), 8u);
  const Marker arrow = shown("normals").at(0);
  EXPECT_EQ(point(arrow, 1), Vector3d(0.25, 0.5, 0.0));
  EXPECT_TRUE(point(arrow, 0).isApprox(Vector3d(0.25, 0.5, 0.07 * kSize), 1e-9));
  EXPECT_NEAR(arrow.scale.y, 0.22 * 0.07 * kSize, 1e-9);
  for (int i = 0; i < 40; ++i) {
    answer->contacts.push_back(contact_at(0, -0.1, 8.0, 0.0));
    answer->contacts.push_back(contact_at(0, 0.1, 0.25, 0.0));
  }
  const Markers arrows = drawn(scene_with(answer), "normals");
  ASSERT_EQ(arrows.size(), 30u);
  for (const Marker& arrow : arrows) EXPECT_EQ(point(arrow, 1).x(), 0.25);
}

TEST_F(Viewer, SeesTheNameOfEachTouchingLinkAtItsDeepestContact) {
  const auto answer = answer_with(
      {contact_at(0, 0.1, 0.1, 0.0), contact_at(1, 0.3, 0.2, 0.0), contact_at(1, 0.2, 0.3, 0.0)});
  answer->contacts[2].link = 1;
  answer->links = {"wrist", "jaw"};
  const Markers names = drawn(scene_with(answer), "names");
  EXPECT_EQ(text_of(names), "hook\njaw");  // The shaft has no name of its own.
  EXPECT_DOUBLE_EQ(names[0].pose.position.x, 0.2);
  EXPECT_DOUBLE_EQ(names[1].pose.position.x, 0.3);
  EXPECT_GT(names[1].pose.position.z, names[0].pose.position.z + names[0].scale.z);
}

TEST_F(Viewer, SeesALineFromToolToOrgan) {
  const auto answer = answer_near();
  const Markers found = drawn(scene_with(answer), "clearance");
  ASSERT_EQ(found.size(), 1u);  // No text: it would hide the status, which has the length.
  EXPECT_EQ(found[0].type, Marker::LINE_LIST);
  EXPECT_EQ(point(found[0], 0), to_eigen(answer->clearance.on_tool));
  EXPECT_EQ(point(found[0], 1), to_eigen(answer->clearance.on_organ));
  for (const std::uint8_t state : {Clearance::NOT_ASKED, Clearance::BEYOND_MARGIN}) {
    answer->clearance.state = state;
    EXPECT_TRUE(drawn(scene_with(answer), "clearance").empty());
  }
}

TEST_F(Viewer, SeesTheNearestFacesTheNearerTheMoreOpaque) {
  const auto answer = answer_near();
  answer->near = {contact_at(1, -0.01, 0, 0), contact_at(0, -0.04, 0, 0)};
  const Marker faces = drawn(scene_with(answer), "near").at(0);
  ASSERT_EQ(faces.points.size(), 12u);  // Two sides of each face.
  EXPECT_NEAR(faces.colors[6].a / faces.colors[0].a, 0.2 / 0.8, 1e-5);
  answer->near.assign(2005, contact_at(0, -0.01, 0, 0));
  EXPECT_EQ(drawn(scene_with(answer), "near").at(0).points.size(), 6 * 2000u);
}

TEST_F(Viewer, ReadsWhatTheAnswerTells) {
  const std::vector<std::pair<std::function<void(ContactArray&)>, const char*>> rows = {
      {[](auto& a) { a.placement.tip = ToolPlacement::OUTSIDE; }, "touches nothing"},
      {[](auto& a) { a.placement.tip = ToolPlacement::ON_SURFACE; },
       "touches nothing, tip on the surface"},
      {[](auto& a) { a.placement.tip = ToolPlacement::INSIDE; }, "touches nothing, tip inside"},
      {[](auto& a) { a.placement.length_inside = 0.0321; },
       "touches nothing, 32.1 mm of its axis inside"},
      {[](auto& a) { a.clearance = answer_near()->clearance; }, "touches nothing, 32.0 mm away"},
      {[](auto& a) {
         a.clearance = answer_near()->clearance;
         a.clearance.unresolved = true;
       },
       "touches nothing, at most 32.0 mm away"},
      {[](auto& a) { a.clearance.state = Clearance::BEYOND_MARGIN; },
       "touches nothing, more than 0.0 mm away"},
      {[](auto& a) {
         a.contacts = {contact_at(0, -0.001, 0, 0), contact_at(1, 0.0349, 0, 0)};
       },
       "2 contacts, 34.9 mm deep"},
      {[](auto& a) {
         a.clearance = answer_near()->clearance;
         a.contacts = {contact_at(0, 0.0012, 0, 0)};
       },
       "1 contact, 1.2 mm deep"},
      {[](auto& a) { set_failure(a, ContactArray::NO_TRANSFORM, "frame 'hook_tip' is unknown"); },
       "no transform: frame 'hook_tip' is unknown"}};
  for (const auto& [edit, line] : rows) {
    const auto answer = answer_with({});
    edit(*answer);
    const Markers status = drawn(scene_with(answer), "status");
    EXPECT_EQ(text_of(status), std::string("liver: 2 faces\nhook: ") + line);
    EXPECT_EQ(status.at(0).color, colours::kText);
    EXPECT_EQ(status.at(1).color, answer->status == 0 ? colours::kText : colours::kFailure);
  }
  Scene scene = scene_with(nullptr);
  scene.organs.push_back(square("kidney"));
  EXPECT_EQ(text_of(drawn(scene, "status")),
            "liver: 2 faces\nhook: no answer yet\nkidney: 2 faces");
  EXPECT_EQ(shown("status").at(2).header.frame_id, "kidney_frame");
}

TEST_F(Viewer, SeesTheStatusBelowTheOrganInLinesThatFitIntoTheWindow) {
  const auto answer = answer_with({});
  const std::string reason =
      "a reason of many words, of which the last one goes on and on behind the edge of a window";
  set_failure(*answer, ContactArray::NO_TRANSFORM, reason);
  Scene scene = scene_with(answer);
  scene.tools = std::make_shared<std::vector<Tool>>(1, shaft_tool(std::string(80, 'x'), 0.02));
  const Markers lines = drawn(scene, "status");
  ASSERT_GT(lines.size(), 3u);
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += " " + lines[i].text;
    // A word that is longer than a line stays whole.
    const bool has_long_word = lines[i].text.find("xx") != std::string::npos;
    EXPECT_LE(lines[i].text.size(), has_long_word ? 81u : 80u);
    EXPECT_DOUBLE_EQ(lines[i].pose.position.x, 0.5);
    EXPECT_LT(lines[i].pose.position.z, -0.2 * kSize) << "tools come from above, and would hide it";
    if (i == 0) continue;
    const double lower = lines[i - 1].pose.position.z - lines[i].pose.position.z;
    EXPECT_GT(lower, 1.2 * lines[i].scale.z);
    EXPECT_LT(lower, 2.0 * lines[i].scale.z);
  }
  EXPECT_EQ(text, " liver: 2 faces " + std::string(80, 'x') + ": no transform: " + reason);
}

TEST_F(Viewer, ReadsOnlyOfNearToolsIfThereAreSeveralOrgans) {
  const auto answer = answer_with({});
  answer->clearance.state = Clearance::BEYOND_MARGIN;
  Scene scene = scene_with(answer);
  scene.organs.push_back(square("kidney"));
  EXPECT_EQ(text_of(drawn(scene, "status")), "liver: 2 faces\nkidney: 2 faces");
  answer->placement.tip = ToolPlacement::INSIDE;
  EXPECT_NE(text_of(drawn(scene, "status")).find("hook: touches nothing"), std::string::npos);
  answer->placement.tip = ToolPlacement::OUTSIDE;
  answer->contacts = {contact_at(0, 0.001, 0.25, 0.5)};
  EXPECT_NE(text_of(drawn(scene, "status")).find("hook: 1 contact"), std::string::npos);
  answer->contacts.clear();
  answer->status = ContactArray::NO_TRANSFORM;
  EXPECT_NE(text_of(drawn(scene, "status")).find("hook: no transform"), std::string::npos);
}

namespace {

Isometry3d tilted() {
  return Eigen::Translation3d(0.3, -0.1, 0.2) *
         Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized());
}

/// A tool with one link of one part.
Tool tool_of(const LinkPart& part) {
  Tool tool = grasper();
  tool.links = {{"jaw", {part}}};
  return tool;
}

}  // namespace

TEST_F(Viewer, SeesAShaftAsACapsuleInTheFirstOrgansFrameThatKnowsItsPose) {
  Scene scene = scene_of(shaft_tool("hook", 0.25), {{{0, 0, 2}, {0, 4, 2}}, {}});
  scene.organs.push_back(square("spleen"));
  scene.organs.insert(scene.organs.begin(), square("kidney"));
  scene.organs[0].pairs = {{0, nullptr, std::nullopt}};
  scene.organs[2].pairs = scene.organs[1].pairs;
  const Markers shaft = drawn(scene, "tools");
  ASSERT_EQ(shaft.size(), 3u);
  EXPECT_EQ(shaft[0].type, Marker::CYLINDER);
  EXPECT_EQ(shaft[0].header.frame_id, "liver_frame");
  EXPECT_DOUBLE_EQ(shaft[0].scale.x, 0.5);
  EXPECT_DOUBLE_EQ(shaft[0].scale.z, 4.0);
  EXPECT_TRUE((to_eigen(shaft[0].pose) * Vector3d(0, 0, 2)).isApprox(Vector3d(0, 4, 2), 1e-12));
  EXPECT_EQ(shaft[1].type, Marker::SPHERE);
  EXPECT_DOUBLE_EQ(shaft[2].pose.position.y, 4.0);
  EXPECT_DOUBLE_EQ(shaft[2].scale.y, 0.5);
  EXPECT_EQ(drawn(scene_of(shaft_tool("hook", 0.25), {{{1, 2, 3}, {1, 2, 3}}, {}}), "tools").size(),
            3u)
      << "a ball";
}

TEST_F(Viewer, SeesALinkAsASphereACylinderABoxOrAMesh) {
  const auto marker_of = [&](const LinkPart& part) {
    return drawn(scene_of(tool_of(part), {{}, {tilted()}}), "tools").at(0);
  };
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

  const std::vector<Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Marker mesh = marker_of(LinkPart::mesh({corners, {FaceIndices{0, 1, 2}}}));
  EXPECT_EQ(mesh.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(mesh.points.size(), 3u);
  EXPECT_TRUE(to_eigen(mesh.pose).isApprox(tilted(), 1e-12));
  const std::vector<FaceIndices> many(5001, {0, 1, 2});
  EXPECT_EQ(marker_of(LinkPart::mesh({corners, many})).type, Marker::CUBE);
}
