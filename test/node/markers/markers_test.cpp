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

const double kSize = std::sqrt(2.0);  // Of the square.

std::shared_ptr<const TriangleMesh> mesh_of(const std::vector<std::uint32_t>& corners) {
  return std::make_shared<const TriangleMesh>(
      TriangleMesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, corners));
}

/// A mesh with this many faces, all at one place.
std::shared_ptr<const TriangleMesh> mesh_of(std::size_t faces) {
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < faces; ++i) corners.insert(corners.end(), {0, 1, 2});
  return mesh_of(corners);
}

/// A square of two faces in the plane z = 0, from (0, 0) to (1, 1) [m].
SceneOrgan square(const std::string& name = "liver") {
  return {name, name + "_frame", mesh_of({0, 1, 2, 1, 3, 2})};
}

/// A contact in the plane z = 0, whose tool is above.
Contact contact_at(std::uint32_t face, double depth, double x = 0.7, double y = 0.7) {
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

/// The hook is 32 mm from the square.
ContactArrayPtr answer_near() {
  const auto answer = answer_with({});
  answer->clearance.state = Clearance::KNOWN;
  answer->clearance.margin = 0.05;
  answer->clearance.distance = 0.032;
  answer->clearance.on_tool.z = 0.032;
  return answer;
}

/// A square and a tool across it. `seconds`: of a clock.
Scene scene_with(const ContactArrayConstPtr& answer, double seconds = 0.0,
                 const SceneOrgan& organ = square(), const Tool& tool = shaft_tool("hook", 0.02),
                 const ToolPose& pose = {{{0.3, 0.4, 1.0}, {0.9, 0.4, -0.2}}, {}}) {
  Scene scene;
  scene.time = SteadyTime() + std::chrono::duration_cast<SteadyTime::duration>(
                                  std::chrono::duration<double>(1000.0 + seconds));
  scene.tools = std::make_shared<std::vector<Tool>>(1, tool);
  scene.organs = {organ};
  scene.organs[0].pairs = {{0, answer, pose}};
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
        if (marker.action == Marker::DELETE) shown_.erase({marker.ns, marker.id});
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

}  // namespace

TEST_F(Viewer, SeesTheWholeScene) {
  Scene scene = scene_with(answer_with({contact_at(1, 0.004)}));
  const ToolPath turn{{0.0, {{0, 0, 1}, {0, 0, 0}}}, {1.0, {{0, 0, 1}, {1, 0, 0}}}};
  scene.organs[0].pairs[0].steps = {{answer_with({contact_at(1, 0.006)}), turn}};
  DurationStatistics times;
  times.add(42e-6);
  scene.query_times = &times;
  EXPECT_EQ(paint(scene), 1u);
  EXPECT_EQ(namespaces(),
            (Names{"surface/liver", "tools", "swept", "touched", "normals", "names", "status"}));
  const Marker surface = shown("surface/liver").at(0), touched = shown("touched").at(0);
  EXPECT_EQ(surface.header.frame_id, "liver_frame");
  ASSERT_EQ(surface.points.size(), 6u);
  ASSERT_EQ(touched.points.size(), 6u);  // Both sides of the face.
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(point(surface, i), scene.organs[0].mesh->triangle(i / 3)[i % 3]) << i;
    const Vector3d lift = point(touched, i) - scene.organs[0].mesh->triangle(1)[i % 3];
    EXPECT_LT((lift - Vector3d(0, 0, (i < 3 ? 1e-3 : -1e-3) * kSize)).norm(), 1e-7);
  }
  EXPECT_EQ(touched.colors.at(0), colours::depth(0.6)) << "of 10 mm, the deepest contact counts";
  EXPECT_EQ(shown("swept").at(0).points.size(), 3u) << "what has no area is left out";
  EXPECT_EQ(text_of(shown("status")),
            "liver: 2 faces\nhook: 1 contact, 4.0 mm deep\n0.042 ms a query");
}

TEST_F(Viewer, SeesNothingOfWhatIsGoneAndTheWholeSceneIfItIsNew) {
  Scene scene = scene_with(answer_with({contact_at(1, 0.004)}));
  scene.organs.push_back(square("kidney"));
  paint(scene);
  EXPECT_NE(shown("surface/liver").at(0).color, shown("surface/kidney").at(0).color);
  const SceneOrgan organ = scene.organs[0];
  paint(scene_with(answer_with({}), 0.1, organ));
  EXPECT_EQ(namespaces(), (Names{"surface/liver", "tools", "status"}));
  shown_[{"of an earlier run", 7}] = {};
  scene = scene_with(answer_with({}), 0.2, organ);
  scene.anew = true;
  EXPECT_EQ(paint(scene), 1u);
  EXPECT_EQ(namespaces(), (Names{"surface/liver", "tools", "status"}));
  scene.anew = false;
  scene.settings.surface_rate_hz = 0.0;  // Switched off.
  paint(scene);
  EXPECT_EQ(namespaces(), (Names{"tools", "status"}));
  scene.organs.clear();
  paint(scene);
  EXPECT_TRUE(shown_.empty());
}

TEST_F(Viewer, GetsASurfaceAtItsRateALargeOneLessOftenAndARestingOneSeldom) {
  SceneOrgan organ = square();
  EXPECT_EQ(paint(scene_with(nullptr, 0.0, organ)), 1u);
  EXPECT_EQ(paint(scene_with(nullptr, 0.5, organ)), 0u);
  EXPECT_EQ(paint(scene_with(nullptr, 1.1 * kRefreshSec, organ)), 1u);
  for (const std::size_t faces : {std::size_t{2}, static_cast<std::size_t>(kFacesPerSecond / 10)}) {
    painter_ = MarkerPainter();
    std::size_t sent = 0;
    const auto mesh = mesh_of(faces);
    for (int i = 0; i < 100; ++i) {
      organ.mesh = std::make_shared<const TriangleMesh>(*mesh);
      Scene scene = scene_with(nullptr, 0.01 * i, organ);
      scene.settings.surface_rate_hz = 20.0;
      sent += paint(scene);
    }
    const std::size_t markers = (faces + kFacesPerMarker - 1) / kFacesPerMarker;
    EXPECT_GE(sent, (faces > 2 ? 9 : 17) * markers);
    EXPECT_LE(sent, (faces > 2 ? 10 : 20) * markers);
  }
}

TEST_F(Viewer, GetsALargeSurfaceInPartsAndNoScrapsOfItWithASmallerOne) {
  SceneOrgan organ = square();
  organ.mesh = mesh_of(2 * kFacesPerMarker + 5);
  EXPECT_EQ(paint(scene_with(nullptr, 0.0, organ)), 3u);
  EXPECT_EQ(shown("surface/liver").at(1).points.size(), 3 * kFacesPerMarker);
  EXPECT_EQ(shown("surface/liver").at(2).points.size(), 15u);
  organ.mesh = mesh_of(kFacesPerMarker);
  EXPECT_EQ(paint(scene_with(nullptr, 1.0, organ)), 1u);
  EXPECT_EQ(shown("surface/liver").size(), 1u);
}

TEST_F(Viewer, SeesDepthsThatGetDarkerAndAreClamped) {
  const auto brightness = [](const std_msgs::ColorRGBA& colour) {
    return 0.3 * colour.r + 0.6 * colour.g + 0.1 * colour.b;
  };
  for (int i = 0; i < 100; ++i) {
    EXPECT_GT(brightness(colours::depth(0.01 * i)), brightness(colours::depth(0.01 * (i + 1))));
  }
  EXPECT_EQ(colours::depth(-3.0), colours::depth(0.0));
  EXPECT_EQ(colours::depth(std::numeric_limits<double>::infinity()), colours::depth(1.0));
  SceneOrgan organ = square();
  organ.mesh = mesh_of({0, 1, 1});  // A face without an area has no normal.
  EXPECT_EQ(drawn(scene_with(answer_with({contact_at(0, 0)}), 0.0, organ), "touched").size(), 1u);
}

TEST_F(Viewer, SeesOutlinesAndTheDeepestContactsAsArrows) {
  const auto answer = answer_with({contact_at(0, 0.1, 0.25, 0.5)});
  answer->regions.resize(2);
  answer->regions[1].points.resize(4);
  EXPECT_EQ(drawn(scene_with(answer), "regions").at(0).points.size(), 8u);
  const Marker arrow = shown("normals").at(0);
  EXPECT_EQ(point(arrow, 1), Vector3d(0.25, 0.5, 0.0));
  EXPECT_TRUE(point(arrow, 0).isApprox(Vector3d(0.25, 0.5, 0.07 * kSize), 1e-9));
  for (int i = 0; i < 40; ++i) {
    answer->contacts.push_back(contact_at(0, -0.1, 8.0));
    answer->contacts.push_back(contact_at(0, 0.1, 0.25));
  }
  const Markers arrows = drawn(scene_with(answer), "normals");
  ASSERT_EQ(arrows.size(), 30u);
  for (const Marker& arrow : arrows) EXPECT_EQ(point(arrow, 1).x(), 0.25);
}

TEST_F(Viewer, SeesTheNameOfEachTouchingLinkAtItsDeepestContact) {
  const auto answer =
      answer_with({contact_at(0, 0.1, 0.1), contact_at(1, 0.3, 0.2), contact_at(1, 0.2, 0.3)});
  answer->contacts[2].link = 1;
  answer->links = {"wrist", "jaw"};
  const Markers names = drawn(scene_with(answer), "names");
  EXPECT_EQ(text_of(names), "hook\njaw");  // The shaft has no name of its own.
  EXPECT_DOUBLE_EQ(names[0].pose.position.x, 0.2);
  EXPECT_DOUBLE_EQ(names[1].pose.position.x, 0.3);
  EXPECT_GT(names[1].pose.position.z, names[0].pose.position.z + names[0].scale.z);
}

TEST_F(Viewer, SeesTheClearanceAndTheNearestFacesTheNearerTheMoreOpaque) {
  const auto answer = answer_near();
  const Marker line = drawn(scene_with(answer), "clearance").at(0);
  EXPECT_EQ(point(line, 0), Vector3d(0.0, 0.0, 0.032));
  EXPECT_EQ(point(line, 1), Vector3d(0.0, 0.0, 0.0));
  answer->near = {contact_at(1, -0.01), contact_at(0, -0.04)};
  const Marker faces = drawn(scene_with(answer), "near").at(0);
  ASSERT_EQ(faces.points.size(), 12u);  // Two sides of each face.
  EXPECT_NEAR(faces.colors[6].a / faces.colors[0].a, 0.2 / 0.8, 1e-5);
  answer->near.assign(2005, contact_at(0, -0.01));
  EXPECT_EQ(drawn(scene_with(answer), "near").at(0).points.size(), 6 * 2000u);
  answer->clearance.state = Clearance::BEYOND_MARGIN;
  EXPECT_TRUE(drawn(scene_with(answer), "clearance").empty());
}

TEST_F(Viewer, ReadsWhatTheAnswerTells) {
  const std::vector<std::pair<std::function<void(ContactArray&)>, const char*>> rows = {
      {[](auto& a) { a.placement.tip = ToolPlacement::OUTSIDE; }, "touches nothing"},
      {[](auto& a) { a.placement.tip = ToolPlacement::ON_SURFACE; },
       "touches nothing, tip on the surface"},
      {[](auto& a) {
         a.placement.tip = ToolPlacement::INSIDE;
         a.placement.length_inside = 0.0321;
       },
       "touches nothing, tip inside, 32.1 mm of its axis inside"},
      {[](auto& a) { a.clearance = answer_near()->clearance; }, "touches nothing, 32.0 mm away"},
      {[](auto& a) {
         a.clearance = answer_near()->clearance;
         a.clearance.unresolved = true;
       },
       "touches nothing, at most 32.0 mm away"},
      {[](auto& a) { a.clearance.state = Clearance::BEYOND_MARGIN; },
       "touches nothing, more than 0.0 mm away"},
      {[](auto& a) {
         a.clearance = answer_near()->clearance;
         a.contacts = {contact_at(0, -0.001), contact_at(1, 0.0349)};
       },
       "2 contacts, 34.9 mm deep"},
      {[](auto& a) { set_failure(a, ContactArray::NO_TRANSFORM, "frame 'hook_tip' is unknown"); },
       "no transform: frame 'hook_tip' is unknown"}};
  for (const auto& [edit, line] : rows) {
    const auto answer = answer_with({});
    edit(*answer);
    const Markers status = drawn(scene_with(answer), "status");
    EXPECT_EQ(text_of(status), std::string("liver: 2 faces\nhook: ") + line);
    EXPECT_EQ(status.at(1).color, answer->status == 0 ? colours::kText : colours::kFailure);
  }
  Scene scene = scene_with(nullptr);
  scene.organs.push_back(square("kidney"));
  EXPECT_EQ(text_of(drawn(scene, "status")),
            "liver: 2 faces\nhook: no answer yet\nkidney: 2 faces");
  const auto far = answer_with({});
  far->clearance.state = Clearance::BEYOND_MARGIN;
  scene.organs[0].pairs[0].answer = far;
  EXPECT_EQ(text_of(drawn(scene, "status")), "liver: 2 faces\nkidney: 2 faces")
      << "with several organs, tools that are far have no line";
}

TEST_F(Viewer, SeesTheStatusBelowTheOrganInLinesThatFitIntoTheWindow) {
  const auto answer = answer_with({});
  const std::string reason =
      "a reason of many words, of which the last one goes on and on behind the edge of a window";
  set_failure(*answer, ContactArray::NO_TRANSFORM, reason);
  const Markers lines = drawn(scene_with(answer), "status");
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1].text + " " + lines[2].text, "hook: no transform: " + reason);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_LE(lines[i].text.size(), 80u);
    EXPECT_LT(lines[i].pose.position.z, -0.2 * kSize) << "tools come from above, and would hide it";
    if (i == 0) continue;
    EXPECT_GT(lines[i - 1].pose.position.z - lines[i].pose.position.z, 1.2 * lines[i].scale.z);
  }
}

TEST_F(Viewer, SeesAShaftAsACapsuleInTheFirstOrgansFrameThatKnowsItsPose) {
  const ToolPose pose{{{0, 0, 2}, {0, 4, 2}}, {}};
  Scene scene = scene_with(nullptr, 0.0, square(), shaft_tool("hook", 0.25), pose);
  scene.organs.insert(scene.organs.begin(), square("kidney"));
  scene.organs[0].pairs = {{0, nullptr, std::nullopt}};
  scene.organs.push_back(square("spleen"));
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
}

TEST_F(Viewer, SeesALinkAsASphereACylinderABoxOrAMesh) {
  const Isometry3d tilted = Eigen::Translation3d(0.3, -0.1, 0.2) *
                            Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized());
  const auto marker_of = [&](const LinkPart& part) {
    Tool tool = grasper();
    tool.links = {{"jaw", {part}}};
    return drawn(scene_with(nullptr, 0.0, square(), tool, {{}, {tilted}}), "tools").at(0);
  };
  const Marker ball = marker_of(LinkPart::sphere({0.1, 0.2, 0.3}, 0.05));
  EXPECT_EQ(ball.type, Marker::SPHERE);
  EXPECT_DOUBLE_EQ(ball.scale.x, 0.1);
  EXPECT_TRUE(to_eigen(ball.pose).translation().isApprox(tilted * Vector3d(0.1, 0.2, 0.3)));

  const Isometry3d place(Eigen::Translation3d(0.0, 0.1, 0.0));
  const Marker cylinder = marker_of(LinkPart::cylinder(place, 0.02, 0.3));
  EXPECT_EQ(cylinder.type, Marker::CYLINDER);
  EXPECT_NEAR(cylinder.scale.x, 0.04, 1e-5);
  const Vector3d end = tilted * Vector3d(0.0, 0.1, 0.15);
  EXPECT_TRUE((to_eigen(cylinder.pose) * Vector3d(0, 0, 0.15)).isApprox(end, 1e-4));

  const Marker box = marker_of(LinkPart::box(Isometry3d::Identity(), {0.1, 0.2, 0.3}));
  EXPECT_EQ(box.type, Marker::CUBE);
  // The marker's axes may be those of the box in another order.
  const Vector3d size(box.scale.x, box.scale.y, box.scale.z);
  const Vector3d extent =
      (tilted.linear().transpose() * to_eigen(box.pose).linear() * size).cwiseAbs();
  EXPECT_TRUE(extent.isApprox(Vector3d(0.1, 0.2, 0.3), 1e-4)) << extent.transpose();

  const std::vector<Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Marker mesh = marker_of(LinkPart::mesh({corners, {FaceIndices{0, 1, 2}}}));
  EXPECT_EQ(mesh.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(mesh.points.size(), 3u);
  EXPECT_TRUE(to_eigen(mesh.pose).isApprox(tilted, 1e-12));
  const std::vector<FaceIndices> many(5001, {0, 1, 2});
  EXPECT_EQ(marker_of(LinkPart::mesh({corners, many})).type, Marker::CUBE);
}
