// Which markers snapshot shows, and the triangles that it makes of them.
#include "programs/snapshot/markers.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "temporary_files.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

Marker marker(const std::string& ns, int id, int action = Marker::ADD, double lifetime_sec = 0.0) {
  Marker marker;
  marker.header.frame_id = "liver";
  marker.header.stamp = ros::Time(3.0);
  marker.ns = ns;
  marker.id = id;
  marker.action = action;
  marker.lifetime = ros::Duration(lifetime_sec);
  return marker;
}

void apply(MarkerStore& store, const std::string& topic, const std::vector<Marker>& markers,
           double now = 10.0) {
  MarkerArray message;
  message.markers = markers;
  store.apply(topic, message, ros::Time(now));
}

using Keys = std::set<MarkerStore::Key>;

Keys shown(const MarkerStore& store) {
  Keys keys;
  for (const auto& [key, entry] : store.entries()) keys.insert(key);
  return keys;
}

TEST(MarkerStore, AddsReplacesAndDeletesTheMarkersOfEachTopic) {
  MarkerStore store;
  apply(store, "a", {marker("x", 1), marker("x", 2), marker("y", 1)});
  apply(store, "b", {marker("x", 1), marker("x", 2)});
  Marker changed = marker("x", 2);
  changed.type = Marker::CUBE;
  apply(store, "a", {changed, marker("y", 1, Marker::DELETE)});
  EXPECT_EQ(shown(store), (Keys{{"a", "x", 1}, {"a", "x", 2}, {"b", "x", 1}, {"b", "x", 2}}));
  EXPECT_EQ(store.entries().at({"a", "x", 2}).marker.type, Marker::CUBE);
  apply(store, "b", {marker("", 0, Marker::DELETEALL), marker("z", 5)});
  EXPECT_EQ(shown(store), (Keys{{"a", "x", 1}, {"a", "x", 2}, {"b", "z", 5}}));
}

TEST(MarkerStore, KeepsLifetimes) {
  const Marker brief = marker("short", 0, Marker::ADD, 0.5);
  MarkerStore store;
  apply(store, "a", {brief, marker("long", 0, Marker::ADD, 1e9), marker("always", 0)});
  store.expire(ros::Time(10.49));
  EXPECT_EQ(store.entries().size(), 3u);
  apply(store, "a", {brief}, 10.49);
  store.expire(ros::Time(10.98));
  EXPECT_EQ(store.entries().size(), 3u) << "a new message begins a new lifetime";
  store.expire(ros::Time(10.99));
  EXPECT_EQ(shown(store), (Keys{{"a", "always", 0}, {"a", "long", 0}}));
}

TEST(MarkerStore, PlacesEachMarkerAtItsStampOnceItsTransformIsKnown) {
  MarkerStore store;
  Marker locked = marker("locked", 0);
  locked.frame_locked = 1;
  apply(store, "a", {locked, marker("free", 0)});
  store.place([](const std::string&, const ros::Time&) { return std::nullopt; });
  EXPECT_FALSE(store.entries().at({"a", "free", 0}).T_fixed_header);
  for (const double x : {1.0, 2.0}) {
    store.place([x](const std::string& frame, const ros::Time& stamp) {
      EXPECT_EQ(frame, "liver");
      return std::optional(Isometry3d(Eigen::Translation3d(x, stamp.toSec(), 0.0)));
    });
  }
  const auto place = [&](const char* name) -> Vector3d {
    return store.entries().at({"a", name, 0}).T_fixed_header->translation();
  };
  EXPECT_EQ(place("free"), Vector3d(1.0, 3.0, 0.0));
  EXPECT_EQ(place("locked"), Vector3d(2.0, 0.0, 0.0)) << "it follows its frame";
}

/// The camera's axes are turned, so that no axis of a marker is one of the picture.
Eigen::Matrix3d axes() {
  return Eigen::Quaterniond(0.7, -0.3, 0.5, 0.2).normalized().toRotationMatrix();
}

Isometry3d header_pose() {
  return Eigen::Translation3d(0.4, -0.2, 0.3) *
         Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized();
}

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point result;
  result.x = x;
  result.y = y;
  result.z = z;
  return result;
}

/// `points`: how many, for lists.
Marker marker(int type, int points = 0) {
  Marker marker;
  marker.type = type;
  marker.pose.position.x = 0.1;
  marker.pose.orientation.z = 1.0;  // half a turn
  marker.scale.x = 0.2;
  marker.scale.y = 0.3;
  marker.scale.z = 0.4;
  marker.color.r = 1.0;
  marker.color.a = 0.5;
  for (int i = 0; i < points; ++i) {
    marker.points.push_back(point(0.1 * i, 0.05 * i * i, 0.02 * (i % 2)));
  }
  return marker;
}

PictureTriangles drawn(const Marker& marker) {
  PictureTriangles triangles;
  add_marker(marker, header_pose(), axes(), triangles);
  EXPECT_EQ(triangles.size() % 3, 0u);
  return triangles;
}

/// In the frame of the marker() above.
Eigen::AlignedBox3d box(const PictureTriangles& triangles) {
  Eigen::AlignedBox3d result;
  for (const PictureVertex& vertex : triangles) {
    const Vector3d in_header = header_pose().inverse() * vertex.position - Vector3d(0.1, 0.0, 0.0);
    result.extend(Vector3d(-in_header.x(), -in_header.y(), in_header.z()));
  }
  return result;
}

TEST(MarkerPicture, SolidsHaveTheirSizeColourAndOutwardNormals) {
  const Vector3d centre = header_pose() * Vector3d(0.1, 0.0, 0.0);
  for (const auto& [type, share] :
       {std::pair(Marker::CUBE, 1.0), {Marker::SPHERE, M_PI / 6}, {Marker::CYLINDER, M_PI / 4}}) {
    for (const double mirrored : {1.0, -1.0}) {
      Marker solid = marker(type);
      solid.scale.x *= mirrored;
      const PictureTriangles triangles = drawn(solid);
      EXPECT_TRUE(box(triangles).min().isApprox(Vector3d(-0.1, -0.15, -0.2), 1e-9)) << type;
      EXPECT_TRUE(box(triangles).max().isApprox(Vector3d(0.1, 0.15, 0.2), 1e-9)) << type;
      double volume = 0.0;  // It is less if there is a hole.
      for (std::size_t i = 0; i < triangles.size(); i += 3) {
        Eigen::Matrix3d corners;
        for (std::size_t j = 0; j < 3; ++j) corners.col(j) = triangles[i + j].position - centre;
        volume += corners.determinant() / 6.0;
      }
      EXPECT_NEAR(volume, share * 0.2 * 0.3 * 0.4, 0.02 * 0.2 * 0.3 * 0.4) << type;
      for (const PictureVertex& vertex : triangles) {
        EXPECT_EQ(vertex.colour, Colour(1, 0, 0, 0.5F));
        EXPECT_NEAR(vertex.normal.norm(), 1.0, 1e-9);
        EXPECT_GT(vertex.normal.dot(vertex.position - centre), 0.0);
      }
    }
  }
}

TEST(MarkerPicture, AnArrowGoesFromPointToPoint) {
  Marker arrow = marker(Marker::ARROW);
  arrow.points = {point(0.0, 0.0, 0.5), point(0.0, 0.0, -0.5)};
  arrow.scale.x = 0.02;
  arrow.scale.y = 0.06;
  arrow.scale.z = 0.1;
  EXPECT_TRUE(box(drawn(arrow)).min().isApprox(Vector3d(-0.03, -0.03, -0.5), 1e-9));
  EXPECT_TRUE(box(drawn(arrow)).max().isApprox(Vector3d(0.03, 0.03, 0.5), 1e-9));
  arrow.points[1] = arrow.points[0];
  EXPECT_TRUE(drawn(arrow).empty());
}

TEST(MarkerPicture, TrianglesAreLitUnlessTheyHaveColours) {
  Marker triangles = marker(Marker::TRIANGLE_LIST, 6);
  for (const PictureVertex& vertex : drawn(triangles)) {
    EXPECT_NEAR(vertex.normal.norm(), 1.0, 1e-9);
  }
  triangles.colors.resize(6);
  for (int i = 0; i < 6; ++i) {
    triangles.colors[i].r = 0.1F * i;
    triangles.colors[i].a = 1.0F;
  }
  const PictureTriangles coloured = drawn(triangles);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(coloured[i].colour, Colour(0.1F * i, 0, 0, 1));
    EXPECT_TRUE(coloured[i].normal.isZero(0.0));
  }
}

TEST(MarkerPicture, LinesHaveTheirWidthAndFaceTheViewer) {
  for (const auto& [type, lines] : {std::pair(Marker::LINE_STRIP, 3), {Marker::LINE_LIST, 2}}) {
    const PictureTriangles triangles = drawn(marker(type, 4));
    ASSERT_EQ(triangles.size(), 6u * lines) << type;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
      const Vector3d a = triangles[i].position;
      const Vector3d normal = (triangles[i + 1].position - a).cross(triangles[i + 2].position - a);
      EXPECT_GT(std::abs(axes().col(2).dot(normal)), 0.0);
      EXPECT_TRUE(triangles[i].normal.isZero(0.0));
    }
    EXPECT_NEAR((triangles[1].position - triangles[0].position).norm(), 0.2, 1e-9);
  }
}

TEST(MarkerPicture, IllegalMarkersAreRefusedAndAddNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::string not_finite = "its pose, scale, points or colours are not finite";
  Marker far = marker(Marker::LINE_LIST, 4), turned = marker(Marker::CUBE), wide = turned,
         dark = turned, coloured = marker(Marker::TRIANGLE_LIST, 6);
  far.points[2].y = turned.pose.orientation.x = dark.color.g = kNan;
  wide.scale.z = std::numeric_limits<double>::infinity();
  coloured.colors.resize(4);
  const std::pair<Marker, std::string> rows[] = {
      {far, not_finite},
      {turned, not_finite},
      {wide, not_finite},
      {dark, not_finite},
      {coloured, "it has 4 colours for 6 points"},
      {marker(Marker::TRIANGLE_LIST, 4), "it has 4 points; must be a multiple of 3"},
      {marker(Marker::LINE_LIST, 3), "it has 3 points; must be a multiple of 2"},
      {marker(Marker::ARROW, 1), "it has 1 points; must be 2"},
      {marker(Marker::POINTS, 3), "its type 8 is not drawn"}};
  for (const auto& [bad, why] : rows) {
    PictureTriangles triangles;
    EXPECT_EQ(input_error([&, &bad = bad] { add_marker(bad, header_pose(), axes(), triangles); }),
              why);
    EXPECT_TRUE(triangles.empty());
  }
}

TEST(MarkerPicture, TextsEmptyListsAndZeroOrientationsAreLegal) {
  for (const int type :
       {Marker::TEXT_VIEW_FACING, Marker::TRIANGLE_LIST, Marker::LINE_LIST, Marker::LINE_STRIP}) {
    EXPECT_TRUE(drawn(marker(type)).empty());
  }
  Marker upright = marker(Marker::CUBE);
  upright.pose.orientation.z = 0.0;
  EXPECT_EQ(drawn(upright).size(), 12u * 4u);
}

TEST(SmoothNormals, LeaveEdgesSharpAndThoseOfADegenerateTriangleZero) {
  for (const PictureVertex& vertex : drawn(marker(Marker::CUBE))) {
    const Vector3d in_header = header_pose().linear().transpose() * vertex.normal;
    EXPECT_NEAR(in_header.cwiseAbs().maxCoeff(), 1.0, 1e-12);
  }
  const Vector3d a{0.1, 0.2, 0.3}, b{0.4, 0.1, 0.2}, c{0.3, 0.5, 0.1};
  const std::vector<Vector3d> normals = smooth_normals({a, b, a, a, b, c});
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(normals[i].isZero(0.0));
  const Vector3d expected = (b - a).cross(c - a).normalized();
  for (int i = 3; i < 6; ++i) EXPECT_TRUE(normals[i].isApprox(expected, 1e-12));
}

}  // namespace
}  // namespace organ_collision
