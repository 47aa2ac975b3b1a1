#include "ros/publishing/markers.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <map>

#include "test/ros/tools/hand_made_tools.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;

namespace {

const TriangleMesh kMesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, {0, 1, 2, 1, 3, 2});
const Tool kHook = shaft_tool("hook", 0.25);

class Markers : public testing::Test {
 protected:
  Markers() {
    answer_->organ = "liver";
    answer_->tool = "hook";
    answer_->header.frame_id = "liver_frame";
  }

  /// The markers by the last part of their namespace.
  std::map<std::string, Marker> markers(const ToolPath& path, const Tool& tool = kHook) {
    std::map<std::string, Marker> by_name;
    for (const Marker& marker : step_markers({answer_, tool, kMesh, path}).markers) {
      EXPECT_EQ(marker.header.frame_id, "liver_frame");
      EXPECT_EQ(marker.ns.rfind("liver/hook/", 0), 0u);
      EXPECT_GT(marker.lifetime.toSec(), 0.0);
      by_name[marker.ns.substr(11)] = marker;
    }
    return by_name;
  }

  ContactArrayPtr answer_ = boost::make_shared<ContactArray>();
  ToolPath still_{{0.0, {{0.0, 0.0, 2.0}, {0.0, 4.0, 2.0}}}};
};

}  // namespace

TEST_F(Markers, ShaftLiesOnTheAxis) {
  const Marker shaft = markers(still_).at("shaft");
  EXPECT_EQ(shaft.type, Marker::CYLINDER);
  EXPECT_DOUBLE_EQ(shaft.pose.position.y, 2.0);
  EXPECT_DOUBLE_EQ(shaft.pose.position.z, 2.0);
  EXPECT_DOUBLE_EQ(shaft.scale.x, 0.5);
  EXPECT_DOUBLE_EQ(shaft.scale.z, 4.0);
  const auto& q = shaft.pose.orientation;
  const Eigen::Vector3d along = Eigen::Quaterniond(q.w, q.x, q.y, q.z) * Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(along.isApprox(Eigen::Vector3d::UnitY(), 1e-12)) << along.transpose();
}

TEST_F(Markers, ABallHasAShaftWithoutLength) {
  const Marker shaft = markers({{0.0, {{1, 2, 3}, {1, 2, 3}}}}).at("shaft");
  EXPECT_GT(shaft.scale.z, 0.0);
  const auto& q = shaft.pose.orientation;
  EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1.0, 1e-12);
}

TEST_F(Markers, TouchedFacesAreDrawnOnBothSides) {
  answer_->contacts.resize(1);
  answer_->contacts[0].face = 1;
  const Marker faces = markers(still_).at("touched");
  EXPECT_EQ(faces.action, Marker::ADD);
  ASSERT_EQ(faces.points.size(), 6u);
  EXPECT_EQ(faces.points[1].x, 1.0);
  EXPECT_EQ(faces.points[1].y, 1.0);
  EXPECT_GT(faces.points[1].z, 0.0);
  EXPECT_LT(faces.points[4].z, 0.0);
}

TEST_F(Markers, WhatIsEmptyIsTakenAway) {
  const auto by_name = markers(still_);
  for (const char* name : {"touched", "swept", "regions"}) {
    EXPECT_EQ(by_name.at(name).action, Marker::DELETE) << name;
  }
}

TEST_F(Markers, SweptSurfaceOfEachLeg) {
  const ShaftAxis begin{{0, 0, 1}, {0, 0, 0}}, turned{{0, 0, 1}, {1, 0, 0}};
  const ShaftAxis moved{{0, 2, 1}, {1, 2, 0}};
  const Marker swept = markers({{0.0, begin}, {0.5, turned}, {1.0, moved}}).at("swept");
  EXPECT_EQ(swept.action, Marker::ADD);
  EXPECT_EQ(swept.points.size(), 9u);  // A triangle, then a quadrangle.
}

TEST_F(Markers, RegionsAreClosedOutlines) {
  answer_->regions.resize(2);
  answer_->regions[1].points.resize(4);
  EXPECT_EQ(markers(still_).at("regions").points.size(), 8u);
}

TEST_F(Markers, LinksAloneHaveTouchedFacesAlone) {
  answer_->contacts.resize(1);
  const auto by_name =
      markers({{0.0, still_[0].axis, {2, Eigen::Isometry3d::Identity()}}}, grasper());
  EXPECT_EQ(by_name.size(), 2u);
  EXPECT_EQ(by_name.at("touched").action, Marker::ADD);
  EXPECT_EQ(by_name.at("regions").action, Marker::DELETE);
}

TEST_F(Markers, NoneOfAFailure) { EXPECT_TRUE(markers({}).empty()); }
