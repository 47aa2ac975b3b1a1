#include "ros/markers/answer_markers.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include "hand_made_scenes.hpp"
#include "ros/markers/marker_shapes.hpp"
#include "ros/messages/conversions.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;

namespace {

Marker touched(TouchedFaces& faces, double now, const SceneOrgan& organ = square()) {
  Scene scene = hook_over_square(now);
  MarkerSheet sheet;
  faces.add_markers(scene, organ, sheet);
  return find_marker(sheet.markers(), "touched");
}

}  // namespace

TEST(TouchedFaces, AreDrawnOnBothSides) {
  const SceneOrgan organ = square();
  TouchedFaces faces;
  faces.add(organ, *answer_with({contact_at(1, 0.004, 0.7, 0.7)}), at(0.0));
  const Marker marker = touched(faces, 0.0, organ);
  ASSERT_EQ(marker.points.size(), 6u);
  EXPECT_EQ(marker.points[1].x, 1.0);
  EXPECT_EQ(marker.points[1].y, 1.0);
  EXPECT_GT(marker.points[1].z, 0.0);
  EXPECT_LT(marker.points[4].z, 0.0);
}

TEST(TouchedFaces, AreColouredByDepthAndFade) {
  const SceneOrgan organ = square();
  TouchedFaces faces;
  faces.add(organ, *answer_with({contact_at(1, 0.004, 0.7, 0.7)}), at(0.0));
  EXPECT_EQ(touched(faces, 0.0, organ).colors.at(0), colours::depth(0.4));  // of 10 mm
  const Marker later = touched(faces, 0.2, organ);
  EXPECT_LT(later.colors.at(0).a, 1.0f);
  EXPECT_GT(later.colors.at(0).a, 0.0f);
  EXPECT_EQ(touched(faces, 3.0, organ).type, -1);
  EXPECT_EQ(touched(faces, 0.0, organ).type, -1);  // It has been forgotten.
}

TEST(TouchedFaces, TheDeeperOfTwoToolsCounts) {
  const SceneOrgan organ = square();
  TouchedFaces faces;
  faces.add(organ, *answer_with({contact_at(0, 0.006, 0.1, 0.1)}), at(0.0));
  faces.add(organ, *answer_with({contact_at(0, 0.002, 0.1, 0.1)}), at(0.0));
  EXPECT_EQ(touched(faces, 0.0, organ).colors.at(0), colours::depth(0.6));
  faces.add(organ, *answer_with({contact_at(0, 0.002, 0.1, 0.1)}), at(0.1));
  EXPECT_EQ(touched(faces, 0.1, organ).colors.at(0), colours::depth(0.2));
}

TEST(TouchedFaces, OfEarlierTrianglesAreForgotten) {
  TouchedFaces faces;
  faces.add(square(), *answer_with({contact_at(1, 0.004, 0.7, 0.7)}), at(0.0));
  const SceneOrgan another = square();
  EXPECT_EQ(touched(faces, 0.0, another).type, -1);
  faces.add(another, *answer_with({contact_at(0, 0.004, 0.1, 0.1)}), at(0.0));
  EXPECT_EQ(touched(faces, 0.0, another).points.size(), 6u);
}

TEST(TouchedFaces, OfAnOrganThatIsGoneAreForgotten) {
  const SceneOrgan organ = square();
  TouchedFaces faces;
  faces.add(organ, *answer_with({contact_at(1, 0.004, 0.7, 0.7)}), at(0.0));
  faces.forget_others(Scene());
  EXPECT_EQ(touched(faces, 0.0, organ).type, -1);
}

TEST(Regions, AreClosedOutlines) {
  const auto answer = answer_with({});
  answer->regions.resize(2);
  answer->regions[1].points.resize(4);
  MarkerSheet sheet;
  add_regions(square(), *answer, sheet);
  EXPECT_EQ(find_marker(sheet.markers(), "regions").points.size(), 8u);
}

using namespace organ_collision;

namespace {

using Add = void (*)(const SceneOrgan&, const ContactArray&, double, MarkerSheet&);

std::vector<Marker> markers(Add add, const ContactArray& answer, double share = 1.0) {
  MarkerSheet sheet;
  add(square(), answer, share, sheet);
  return sheet.markers().markers;
}

std::size_t points_of_an_arrow() {
  return markers(add_normals, *answer_with({contact_at(0, 0.1, 0.5, 0.5)})).at(0).points.size();
}

}  // namespace

TEST(Normals, EndAtTheContactFromTheSideOfTheTool) {
  const auto answer = answer_with({contact_at(0, 0.1, 0.25, 0.5)});
  const Marker arrows = markers(add_normals, *answer).at(0);
  EXPECT_EQ(arrows.ns, "normals");
  double lowest = 1.0, highest = -1.0;
  Eigen::Vector3d head = Eigen::Vector3d::Ones();
  for (std::size_t i = 0; i < arrows.points.size(); ++i) {
    if (point(arrows, i).z() < head.z()) head = point(arrows, i);
    lowest = std::min(lowest, point(arrows, i).z());
    highest = std::max(highest, point(arrows, i).z());
  }
  EXPECT_NEAR(lowest, 0.0, 1e-12);
  EXPECT_GT(highest, 0.01);
  EXPECT_TRUE(head.isApprox(Eigen::Vector3d(0.25, 0.5, 0.0), 1e-9)) << head.transpose();
}

TEST(Normals, OnlyTheDeepestContactsHaveArrows) {
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < kMostArrows + 20; ++i) {
    const bool deep = i % 2 == 0 && i < 2 * kMostArrows;
    contacts.push_back(contact_at(0, deep ? 0.1 : -0.1, deep ? 0.5 : 8.0, 0.0));
  }
  contacts.resize(kMostArrows + 20, contact_at(0, 0.2, 0.5, 0.0));
  const Marker arrows = markers(add_normals, *answer_with(contacts)).at(0);
  EXPECT_EQ(arrows.points.size(), kMostArrows * points_of_an_arrow());
  std::size_t shallow = 0;
  for (const auto& p : arrows.points) shallow += p.x > 4.0;
  EXPECT_EQ(shallow, (kMostArrows - (kMostArrows + 20) / 2) * points_of_an_arrow());
}

TEST(Normals, FadeAndVanishWithoutContacts) {
  const auto answer = answer_with({contact_at(0, 0.1, 0.25, 0.5)});
  EXPECT_NEAR(markers(add_normals, *answer, 0.25).at(0).color.a, 0.25, 1e-6);
  EXPECT_TRUE(markers(add_normals, *answer_with({})).empty());
}

TEST(Names, EachTouchingLinkHasOneAtItsDeepestContact) {
  auto contacts = std::vector<Contact>{contact_at(0, 0.1, 0.1, 0.0), contact_at(1, 0.3, 0.2, 0.0),
                                       contact_at(1, 0.2, 0.3, 0.0)};
  contacts[2].link = 2;
  const auto answer = answer_with(contacts);
  answer->links = {"", "wrist", "jaw"};
  const auto names = markers(add_names, *answer);
  ASSERT_EQ(names.size(), 2u);
  EXPECT_EQ(names[0].type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(names[0].text, "hook");  // The shaft has no name of its own.
  EXPECT_DOUBLE_EQ(names[0].pose.position.x, 0.2);
  EXPECT_GT(names[0].pose.position.z, 0.0);
  EXPECT_EQ(names[1].text, "jaw");
  EXPECT_EQ(names[1].id, 1);
}

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

using Add = void (*)(const SceneOrgan&, const ContactArray&, MarkerSheet&);

std::vector<Marker> markers(Add add, const ContactArray& answer) {
  MarkerSheet sheet;
  add(square(), answer, sheet);
  return sheet.markers().markers;
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

}  // namespace

TEST(ClearanceMarkers, ALineFromToolToOrganAndItsLength) {
  const auto answer = answer_near();
  const auto shown = markers(add_clearance, *answer);
  ASSERT_EQ(shown.size(), 2u);
  EXPECT_EQ(shown[0].type, Marker::LINE_LIST);
  EXPECT_EQ(point(shown[0], 0), to_eigen(answer->clearance.on_tool));
  EXPECT_EQ(point(shown[0], 1), to_eigen(answer->clearance.on_organ));
  EXPECT_EQ(shown[1].type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(shown[1].text, "32.0 mm");
  for (const Marker& marker : shown) EXPECT_EQ(marker.ns, "clearance");
}

TEST(ClearanceMarkers, AnUpperBoundIsCalledSo) {
  const auto answer = answer_near();
  answer->clearance.unresolved = true;
  EXPECT_EQ(markers(add_clearance, *answer).at(1).text, "at most 32.0 mm");
}

TEST(ClearanceMarkers, TheTextHasAPlaceForAnyNormal) {
  const auto answer = answer_near();
  for (const Vector3d& normal :
       {Vector3d(0.0, 0.0, 1.0), Vector3d(0.0, 0.0, -1.0), Vector3d(1.0, 0.0, 0.0)}) {
    answer->clearance.normal = to_vector(normal);
    const Vector3d place = to_eigen(markers(add_clearance, *answer).at(1).pose.position);
    const Vector3d middle =
        0.5 * (to_eigen(answer->clearance.on_tool) + to_eigen(answer->clearance.on_organ));
    EXPECT_NEAR((place - middle).dot(normal), -0.06 * square().size(), 1e-6);  // on the tool's side
    EXPECT_NEAR((place - middle).cross(normal).norm(), 0.10 * square().size(), 1e-6);
  }
}

TEST(ClearanceMarkers, NothingIfTheDistanceIsNotKnown) {
  const auto answer = answer_near();
  for (const std::uint8_t state : {Clearance::NOT_ASKED, Clearance::BEYOND_MARGIN}) {
    answer->clearance.state = state;
    EXPECT_TRUE(markers(add_clearance, *answer).empty());
  }
}

TEST(NearFaces, TheNearerTheMoreOpaque) {
  const auto answer = answer_near();
  answer->near = {contact_at(1, -0.01, 0, 0), contact_at(0, -0.04, 0, 0)};
  const Marker faces = markers(add_near_faces, *answer).at(0);
  EXPECT_EQ(faces.ns, "near");
  ASSERT_EQ(faces.points.size(), 12u);  // Two sides of each face.
  ASSERT_EQ(faces.colors.size(), faces.points.size());
  EXPECT_NEAR(faces.colors[6].a / faces.colors[0].a, 0.2 / 0.8, 1e-5);
  const Triangle corners = square().triangle(1);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((point(faces, i) - corners[i]).norm(), 2e-3 * square().size());
    EXPECT_GT(point(faces, i).z() * -point(faces, i + 3).z(), 0.0);
  }
  EXPECT_TRUE(markers(add_near_faces, *answer_near()).empty());
}

TEST(NearFaces, OnlyTheNearestAreDrawn) {
  const auto answer = answer_near();
  answer->near.assign(kMostNearFaces + 5, contact_at(0, -0.01, 0, 0));
  EXPECT_EQ(markers(add_near_faces, *answer).at(0).points.size(), 6 * kMostNearFaces);
}

using namespace organ_collision;

namespace {

const ShaftAxis kAxis{{0.3, 0.4, 1.0}, {0.9, 0.4, -0.2}};
constexpr double kRadius = 0.02;

Crossing crossing(double shaft, int direction) {
  Crossing crossing;
  crossing.shaft = shaft;
  crossing.point = tf2::toMsg(kAxis.at(shaft));
  crossing.direction = static_cast<std::int8_t>(direction);
  return crossing;
}

std::vector<Marker> markers(const std::vector<Crossing>& crossings) {
  ToolPlacement placement;
  placement.crossings = crossings;
  MarkerSheet sheet;
  add_crossings(square(), kAxis, kRadius, placement, sheet);
  return sheet.markers().markers;
}

/// The range of places on the axis of some points of a marker, relative to `from`, in metres.
std::pair<double, double> range(const Marker& marker, std::size_t first, std::size_t last,
                                const Vector3d& from) {
  const Vector3d along = (kAxis.tip - kAxis.trocar).normalized();
  std::pair<double, double> range{1.0, -1.0};
  for (std::size_t i = first; i < last; ++i) {
    const double place = (point(marker, i) - from).dot(along);
    range = {std::min(range.first, place), std::max(range.second, place)};
  }
  return range;
}

}  // namespace

TEST(CrossingMarkers, StandBeforeAnEntryAndBehindAnExit) {
  const Marker heads = markers({crossing(0.4, 1), crossing(0.7, -1)}).at(0);
  EXPECT_EQ(heads.ns, "crossings");
  const std::size_t half = heads.points.size() / 2;
  const auto entry = range(heads, 0, half, kAxis.at(0.4));
  EXPECT_NEAR(entry.second, 0.0, 1e-9);
  EXPECT_LT(entry.first, -kRadius);
  const auto exit = range(heads, half, 2 * half, kAxis.at(0.7));
  EXPECT_NEAR(exit.first, 0.0, 1e-9);
  EXPECT_GT(exit.second, kRadius);
  ASSERT_EQ(heads.colors.size(), heads.points.size());
  EXPECT_NE(heads.colors[0], heads.colors[half]);
}

TEST(CrossingMarkers, AreWiderThanTheShaft) {
  const Marker heads = markers({crossing(0.4, 1)}).at(0);
  const Vector3d along = (kAxis.tip - kAxis.trocar).normalized();
  double widest = 0.0;
  for (std::size_t i = 0; i < heads.points.size(); ++i) {
    widest = std::max(widest, (point(heads, i) - kAxis.trocar).cross(along).norm());
  }
  EXPECT_GT(widest, 1.5 * kRadius);
}

TEST(CrossingMarkers, NoneWithoutCrossingsAndNotTooMany) {
  EXPECT_TRUE(markers({}).empty());
  const std::size_t one = markers({crossing(0.4, 1)}).at(0).points.size();
  const std::vector<Crossing> many(kMostCrossings + 7, crossing(0.4, 1));
  EXPECT_EQ(markers(many).at(0).points.size(), kMostCrossings * one);
}

using namespace organ_collision;

TEST(StatusLine, CountsContactsAndGivesTheGreatestDepth) {
  EXPECT_EQ(status_line("hook", answer_with({})), "hook: touches nothing");
  EXPECT_EQ(status_line("hook", answer_with({contact_at(0, 0.0012, 0, 0)})),
            "hook: 1 contact, 1.2 mm deep");
  const auto two = answer_with({contact_at(0, -0.001, 0, 0), contact_at(1, 0.0349, 0, 0)});
  EXPECT_EQ(status_line("hook", two), "hook: 2 contacts, 34.9 mm deep");
}

TEST(StatusLine, TellsTheDistanceWhereNothingIsTouched) {
  const auto answer = answer_with({});
  answer->clearance.margin = 0.02;
  answer->clearance.state = Clearance::BEYOND_MARGIN;
  EXPECT_EQ(status_line("hook", answer), "hook: touches nothing, more than 20.0 mm away");
  answer->clearance.state = Clearance::KNOWN;
  answer->clearance.distance = 0.0032;
  EXPECT_EQ(status_line("hook", answer), "hook: touches nothing, 3.2 mm away");
  answer->contacts = {contact_at(0, 0.0012, 0, 0)};
  EXPECT_EQ(status_line("hook", answer), "hook: 1 contact, 1.2 mm deep");
}

TEST(StatusLine, TellsWhatIsInside) {
  const auto answer = answer_with({});
  answer->placement.tip = ToolPlacement::OUTSIDE;
  EXPECT_EQ(status_line("hook", answer), "hook: touches nothing");
  answer->placement.tip = ToolPlacement::ON_SURFACE;
  EXPECT_EQ(status_line("hook", answer), "hook: touches nothing, tip on the surface");
  answer->placement.tip = ToolPlacement::INSIDE;
  answer->placement.length_inside = 0.0321;
  EXPECT_EQ(status_line("hook", answer),
            "hook: touches nothing, tip inside, 32.1 mm of its axis inside");
}

TEST(StatusLine, SaysWhyThereIsNoAnswer) {
  const auto answer = answer_with({});
  answer->status = ContactArray::NO_TRANSFORM;
  answer->message = "frame 'hook_tip' is unknown";
  EXPECT_EQ(status_line("hook", answer), "hook: no transform: frame 'hook_tip' is unknown");
  EXPECT_EQ(status_line("hook", nullptr), "hook: no answer yet");
}

TEST(StatusMarkers, StandAboveTheOrgan) {
  Scene scene = hook_over_square();
  scene.organs.push_back(square("kidney"));
  scene.pairs[0].answer = answer_with({contact_at(0, 0.0012, 0, 0)});
  MarkerSheet sheet;
  add_status(scene, scene.organs[0], 42e-6, sheet);
  add_status(scene, scene.organs[1], 0.0, sheet);
  const auto& texts = sheet.markers().markers;
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_EQ(texts[0].text, "liver: 2 faces\nhook: 1 contact, 1.2 mm deep\n42 us a query");
  EXPECT_EQ(texts[0].header.frame_id, "liver_frame");
  EXPECT_EQ(texts[0].color, colours::text());
  EXPECT_DOUBLE_EQ(texts[0].pose.position.x, 0.5);
  EXPECT_GT(texts[0].pose.position.z, 0.0);
  EXPECT_EQ(texts[1].text, "kidney: 2 faces");
}

TEST(StatusMarkers, AreRedWithoutAnAnswer) {
  Scene scene = hook_over_square();
  const auto answer = answer_with({});
  answer->status = ContactArray::STALE_MESH;
  scene.pairs[0].answer = answer;
  MarkerSheet sheet;
  add_status(scene, scene.organs[0], 0.0, sheet);
  EXPECT_EQ(sheet.markers().markers.at(0).color, colours::failure());
}
