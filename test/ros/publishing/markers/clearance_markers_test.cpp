#include "ros/publishing/markers/clearance_markers.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include "ros/interface/conversions.hpp"
#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using Eigen::Vector3d;
using visualization_msgs::Marker;

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
