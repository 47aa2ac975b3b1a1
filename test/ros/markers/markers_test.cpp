#include "ros/markers/markers.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "ros/messages/conversions.hpp"
#include "test/ros/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

const MarkerStyle kStyle{"faces", "liver_frame", colours::kTool};

}  // namespace

TEST(Colours, DepthsGetDarkerAndAreClamped) {
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
  for (std::size_t i = 0; i < 12; ++i) EXPECT_FALSE(colours::tissue(i) == colours::tissue(i + 1));
}

TEST(Visibility, FallsFromOneToZero) {
  EXPECT_NEAR(visibility(at(0.0), at(0.25 * kFadeSec)), 0.75, 1e-6);
  EXPECT_EQ(visibility(at(0.0), at(2.0 * kFadeSec)), 0.0);
  EXPECT_EQ(visibility(at(1.0), at(0.0)), 1.0);
}

TEST(Markers, AreNumberedInEachNamespaceAndFollowTheirFrame) {
  MarkerArray picture;
  for (const char* name : {"a", "b", "a", "a"}) {
    add_marker(make_marker({name, "liver", colours::kTool}, Marker::CUBE), picture);
  }
  ASSERT_EQ(picture.markers.size(), 4u);
  const int ids[] = {0, 0, 1, 2};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(picture.markers[i].id, ids[i]);
  EXPECT_EQ(picture.markers[0].header.frame_id, "liver");
  EXPECT_TRUE(picture.markers[0].header.stamp.isZero() && picture.markers[0].frame_locked);
  EXPECT_EQ(picture.markers[0].pose.orientation.w, 1.0);
}

TEST(Markers, ListsWithoutPointsAndArrowsWithoutLengthAreLeftOut) {
  MarkerArray picture;
  Marker list = make_marker(kStyle, Marker::TRIANGLE_LIST);
  add_marker(list, picture);
  add_arrow(kStyle, Vector3d::Ones(), Vector3d::Ones(), {}, picture);
  EXPECT_TRUE(picture.markers.empty());
  add_point(list, {0.5, 0.25, 2.0});
  add_marker(list, picture);
  ASSERT_EQ(picture.markers.size(), 1u);
  EXPECT_EQ(point(picture.markers[0], 0), Vector3d(0.5, 0.25, 2.0));
}

TEST(Markers, AnArrowIsAsWideAsItsLengthTells) {
  MarkerArray picture;
  add_arrow(kStyle, {1, 0, 0}, {1, 0, 2}, {0.1, 0.2, 0.3}, picture);
  const Marker& arrow = picture.markers.at(0);
  EXPECT_EQ(arrow.type, Marker::ARROW);
  EXPECT_DOUBLE_EQ(arrow.scale.x, 0.2);
  EXPECT_DOUBLE_EQ(arrow.scale.y, 0.4);
  EXPECT_DOUBLE_EQ(arrow.scale.z, 0.6);
  EXPECT_EQ(point(arrow, 0), Vector3d(1, 0, 0));
  EXPECT_EQ(point(arrow, 1), Vector3d(1, 0, 2));
}

TEST(LiftedFace, IsOnBothSidesOfTheSurfaceAndFinite) {
  SceneOrgan organ = square();
  Marker list = make_marker(kStyle, Marker::TRIANGLE_LIST);
  add_lifted_face(organ, 1, colours::kNearFace, list);
  ASSERT_EQ(list.points.size(), 6u);
  const Triangle corners = organ.mesh->triangle(1);
  for (std::size_t i = 0; i < 6; ++i) {
    const Vector3d lift = point(list, i) - corners[i % 3];
    EXPECT_NEAR(lift.z(), (i < 3 ? 1e-3 : -1e-3) * organ.size(), 1e-7);
    EXPECT_NEAR(lift.head<2>().norm(), 0.0, 1e-12);
    EXPECT_EQ(list.colors.at(i), colours::kNearFace);
  }
  organ.mesh =  // A degenerate face.
      std::make_shared<const TriangleMesh>(TriangleMesh({0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2}));
  add_lifted_face(organ, 0, colours::kNearFace, list);
  for (std::size_t i = 6; i < 12; ++i) EXPECT_TRUE(point(list, i).allFinite());
}

namespace {

MarkerArray contacts_of(const ContactArray& answer, double share = 1.0) {
  MarkerArray picture;
  add_contacts(square(), answer, share, picture);
  return picture;
}

MarkerArray surroundings_of(const ContactArray& answer) {
  MarkerArray picture;
  add_surroundings(square(), answer, picture);
  return picture;
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

const ShaftAxis kAxis{{0.3, 0.4, 1.0}, {0.9, 0.4, -0.2}};

Crossing crossing(double shaft, int direction) {
  Crossing crossing;
  crossing.shaft = shaft;
  crossing.point = tf2::toMsg(kAxis.at(shaft));
  crossing.direction = static_cast<std::int8_t>(direction);
  return crossing;
}

std::vector<Marker> cones_of(const std::vector<Crossing>& crossings) {
  ToolPlacement placement;
  placement.crossings = crossings;
  MarkerArray picture;
  add_crossings(square(), kAxis, 0.02, placement, picture);
  return find_markers(picture, "crossings");
}

}  // namespace

TEST(ContactMarkers, RegionsAreClosedOutlines) {
  const auto answer = answer_with({});
  answer->regions.resize(2);
  answer->regions[1].points.resize(4);
  EXPECT_EQ(find_markers(contacts_of(*answer), "regions").at(0).points.size(), 8u);
}

TEST(ContactMarkers, NormalsEndAtTheContactFromTheSideOfTheTool) {
  const auto answer = answer_with({contact_at(0, 0.1, 0.25, 0.5)});
  const Marker arrow = find_markers(contacts_of(*answer, 0.25), "normals").at(0);
  EXPECT_EQ(point(arrow, 1), Vector3d(0.25, 0.5, 0.0));
  EXPECT_TRUE(point(arrow, 0).isApprox(Vector3d(0.25, 0.5, 0.07 * square().size()), 1e-9));
  EXPECT_NEAR(arrow.color.a, 0.25, 1e-6);
  EXPECT_TRUE(contacts_of(*answer_with({})).markers.empty());
}

TEST(ContactMarkers, OnlyTheDeepestContactsHaveArrows) {
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < kMostArrows; ++i) {
    contacts.push_back(contact_at(0, -0.1, 8.0, 0.0));
    contacts.push_back(contact_at(0, 0.1, 0.5, 0.0));
  }
  const auto arrows = find_markers(contacts_of(*answer_with(contacts)), "normals");
  ASSERT_EQ(arrows.size(), kMostArrows);
  for (const Marker& arrow : arrows) EXPECT_EQ(point(arrow, 1).x(), 0.5);
}

TEST(ContactMarkers, EachTouchingLinkHasANameAtItsDeepestContact) {
  auto contacts = std::vector<Contact>{contact_at(0, 0.1, 0.1, 0.0), contact_at(1, 0.3, 0.2, 0.0),
                                       contact_at(1, 0.2, 0.3, 0.0)};
  contacts[2].link = 2;
  const auto answer = answer_with(contacts);
  answer->links = {"", "wrist", "jaw"};
  const auto names = find_markers(contacts_of(*answer), "names");
  ASSERT_EQ(names.size(), 2u);
  EXPECT_EQ(names[0].type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(names[0].text, "hook");  // The shaft has no name of its own.
  EXPECT_DOUBLE_EQ(names[0].pose.position.x, 0.2);
  EXPECT_GT(names[0].pose.position.z, 0.0);
  EXPECT_EQ(names[1].text, "jaw");
  EXPECT_EQ(names[1].id, 1);
}

TEST(ClearanceMarkers, ALineFromToolToOrganAndItsLength) {
  const auto answer = answer_near();
  auto shown = find_markers(surroundings_of(*answer), "clearance");
  ASSERT_EQ(shown.size(), 2u);
  EXPECT_EQ(shown[0].type, Marker::LINE_LIST);
  EXPECT_EQ(point(shown[0], 0), to_eigen(answer->clearance.on_tool));
  EXPECT_EQ(point(shown[0], 1), to_eigen(answer->clearance.on_organ));
  EXPECT_EQ(shown[1].type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(shown[1].text, "32.0 mm");
  answer->clearance.unresolved = true;
  EXPECT_EQ(surroundings_of(*answer).markers.at(1).text, "at most 32.0 mm");
  for (const std::uint8_t state : {Clearance::NOT_ASKED, Clearance::BEYOND_MARGIN}) {
    answer->clearance.state = state;
    EXPECT_TRUE(surroundings_of(*answer).markers.empty());
  }
}

TEST(ClearanceMarkers, TheTextHasAPlaceForAnyNormal) {
  const auto answer = answer_near();
  for (const Vector3d& normal :
       {Vector3d(0.0, 0.0, 1.0), Vector3d(0.0, 0.0, -1.0), Vector3d(1.0, 0.0, 0.0)}) {
    answer->clearance.normal = to_vector(normal);
    const Vector3d place = to_eigen(surroundings_of(*answer).markers.at(1).pose.position);
    const Vector3d middle =
        0.5 * (to_eigen(answer->clearance.on_tool) + to_eigen(answer->clearance.on_organ));
    EXPECT_NEAR((place - middle).dot(normal), -0.06 * square().size(), 1e-6);  // on the tool's side
    EXPECT_NEAR((place - middle).cross(normal).norm(), 0.10 * square().size(), 1e-6);
  }
}

TEST(NearFaces, TheNearestAreDrawnAndTheNearerTheMoreOpaque) {
  const auto answer = answer_near();
  EXPECT_TRUE(find_markers(surroundings_of(*answer), "near").empty());
  answer->near = {contact_at(1, -0.01, 0, 0), contact_at(0, -0.04, 0, 0)};
  const Marker faces = find_markers(surroundings_of(*answer), "near").at(0);
  ASSERT_EQ(faces.points.size(), 12u);  // Two sides of each face.
  ASSERT_EQ(faces.colors.size(), faces.points.size());
  EXPECT_NEAR(faces.colors[6].a / faces.colors[0].a, 0.2 / 0.8, 1e-5);
  answer->near.assign(kMostNearFaces + 5, contact_at(0, -0.01, 0, 0));
  EXPECT_EQ(find_markers(surroundings_of(*answer), "near").at(0).points.size(), 6 * kMostNearFaces);
}

TEST(CrossingMarkers, StandBeforeAnEntryAndBehindAnExit) {
  const auto cones = cones_of({crossing(0.4, 1), crossing(0.7, -1)});
  ASSERT_EQ(cones.size(), 2u);
  EXPECT_TRUE(point(cones[0], 1).isApprox(kAxis.at(0.4), 1e-9));
  EXPECT_TRUE(point(cones[1], 0).isApprox(kAxis.at(0.7), 1e-9));
  EXPECT_NE(cones[0].color, cones[1].color);
  const Vector3d along = (kAxis.tip - kAxis.trocar).normalized();
  for (const Marker& cone : cones) {
    EXPECT_NEAR((point(cone, 1) - point(cone, 0)).normalized().dot(along), 1.0, 1e-9);
    EXPECT_NEAR(cone.scale.y, 2 * 2.5 * 0.02, 1e-9);  // Wider than the shaft.
  }
  const std::vector<Crossing> many(kMostCrossings + 7, crossing(0.4, 1));
  EXPECT_EQ(cones_of(many).size(), kMostCrossings);
}

TEST(StatusLine, TellsWhatTheAnswerTells) {
  const std::vector<std::pair<std::function<void(ContactArray&)>, const char*>> rows = {
      {[](auto& a) { a.placement.tip = ToolPlacement::OUTSIDE; }, "touches nothing"},
      {[](auto& a) { a.placement.tip = ToolPlacement::ON_SURFACE; },
       "touches nothing, tip on the surface"},
      {[](auto& a) { a.placement.tip = ToolPlacement::INSIDE; }, "touches nothing, tip inside"},
      {[](auto& a) { a.placement.length_inside = 0.0321; },
       "touches nothing, 32.1 mm of its axis inside"},
      {[](auto& a) { a.clearance = answer_near()->clearance; }, "touches nothing, 32.0 mm away"},
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
    EXPECT_EQ(status_line("hook", answer), std::string("hook: ") + line);
  }
  EXPECT_EQ(status_line("hook", nullptr), "hook: no answer yet");
}

TEST(StatusMarkers, StandAboveTheOrganAndAreRedWithoutAnAnswer) {
  Scene scene = hook_over_square();
  scene.organs.push_back(square("kidney"));
  scene.pairs[0].answer = answer_with({contact_at(0, 0.0012, 0, 0)});
  MarkerArray picture;
  add_status(scene, scene.organs[0], 42e-6, picture);
  add_status(scene, scene.organs[1], 0.0, picture);
  const auto failed = answer_with({});
  failed->status = ContactArray::STALE_MESH;
  scene.pairs[0].answer = failed;
  add_status(scene, scene.organs[0], 0.0, picture);
  const auto& texts = picture.markers;
  ASSERT_EQ(texts.size(), 3u);
  EXPECT_EQ(texts[0].text, "liver: 2 faces\nhook: 1 contact, 1.2 mm deep\n42 us a query");
  EXPECT_EQ(texts[0].header.frame_id, "liver_frame");
  EXPECT_EQ(texts[0].color, colours::kText);
  EXPECT_DOUBLE_EQ(texts[0].pose.position.x, 0.5);
  EXPECT_GT(texts[0].pose.position.z, 0.0);
  EXPECT_EQ(texts[1].text, "kidney: 2 faces");
  EXPECT_EQ(texts[2].color, colours::kFailure);
}

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

TEST(ProxyMarkers, AFreeProxyHidesItsHandAndLinksHaveProxiesToo) {
  ProxyView view = held_hook();
  view.answer.state = ProxyStatus::kFree;
  view.answer.proxy = *view.hand;
  view.answer.pull.setZero();
  view.answer.contacts.front().load = 0.0;
  EXPECT_EQ(names_of(markers_of(view)), (std::set<std::string>{"proxy", "state"}));
  view.tool = grasper();
  const Isometry3d place(Eigen::Translation3d(0.0, 0.0, 0.1));
  view.hand = view.answer.proxy = {{Vector3d::Zero(), Vector3d::Zero()}, {place, place}};
  EXPECT_EQ(find_markers(markers_of(view), "proxy").size(), 2u);
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
