#include "snapshot/markers.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "snapshot/marker_picture.hpp"

namespace organ_collision {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

Marker marker(const std::string& ns, int id, double lifetime_sec = 0.0) {
  Marker marker;
  marker.header.frame_id = "liver";
  marker.header.stamp = ros::Time(3.0);
  marker.ns = ns;
  marker.id = id;
  marker.lifetime = ros::Duration(lifetime_sec);
  return marker;
}

Marker with_action(Marker marker, int action) {
  marker.action = action;
  return marker;
}

MarkerArray array(const std::vector<Marker>& markers) {
  MarkerArray result;
  result.markers = markers;
  return result;
}

std::set<std::string> shown(const MarkerStore& store) {
  std::set<std::string> result;
  for (const auto& [key, entry] : store.entries()) {
    result.insert(key.topic + " " + key.ns + " " + std::to_string(key.id));
  }
  return result;
}

using Names = std::set<std::string>;

TEST(MarkerStore, AddsReplacesAndDeletes) {
  MarkerStore store;
  const ros::Time now(10.0);
  store.apply("a", array({marker("x", 1), marker("x", 2), marker("y", 1)}), now);
  EXPECT_EQ(shown(store), (Names{"a x 1", "a x 2", "a y 1"}));

  Marker changed = marker("x", 2);
  changed.type = Marker::CUBE;
  store.apply("a", array({changed, with_action(marker("y", 1), Marker::DELETE)}), now);
  EXPECT_EQ(shown(store), (Names{"a x 1", "a x 2"}));
  EXPECT_EQ(store.entries().at({"a", "x", 2}).marker.type, Marker::CUBE);
}

TEST(MarkerStore, TopicsAreSeparate) {
  MarkerStore store;
  store.apply("a", array({marker("x", 1)}), ros::Time(10.0));
  store.apply("b", array({marker("x", 1), marker("x", 2)}), ros::Time(10.0));
  EXPECT_EQ(shown(store), (Names{"a x 1", "b x 1", "b x 2"}));
  store.apply("b", array({with_action(marker("", 0), Marker::DELETEALL), marker("z", 5)}),
              ros::Time(10.0));
  EXPECT_EQ(shown(store), (Names{"a x 1", "b z 5"}));
}

TEST(MarkerStore, KeepsLifetimes) {
  MarkerStore store;
  store.apply("a", array({marker("short", 0, 0.5), marker("long", 0, 1e9), marker("always", 0)}),
              ros::Time(10.0));
  store.expire(ros::Time(10.49));
  EXPECT_EQ(shown(store).size(), 3u);
  store.apply("a", array({marker("short", 0, 0.5)}), ros::Time(10.49));
  store.expire(ros::Time(10.98));
  EXPECT_EQ(shown(store).size(), 3u) << "a new message begins a new lifetime";
  store.expire(ros::Time(10.99));
  EXPECT_EQ(shown(store), (Names{"a always 0", "a long 0"}));
  store.expire(ros::Time(1e9));
  EXPECT_EQ(shown(store), (Names{"a always 0", "a long 0"}));
}

TEST(MarkerStore, PlacesEachMarkerAtItsStampOnceItsTransformIsKnown) {
  MarkerStore store;
  Marker locked = marker("locked", 0);
  locked.frame_locked = 1;
  store.apply("a", array({locked, marker("free", 0)}), ros::Time(10.0));
  store.place([](const std::string&, const ros::Time&) { return std::nullopt; });
  EXPECT_FALSE(store.entries().at({"a", "free", 0}).T_fixed_header);

  const auto at = [](double x) {
    return [x](const std::string& frame, const ros::Time& stamp) {
      EXPECT_EQ(frame, "liver");
      return std::optional(Eigen::Isometry3d(Eigen::Translation3d(x, stamp.toSec(), 0.0)));
    };
  };
  store.place(at(1.0));
  store.place(at(2.0));
  EXPECT_TRUE(store.entries()
                  .at({"a", "free", 0})
                  .T_fixed_header->translation()
                  .isApprox(Eigen::Vector3d(1.0, 3.0, 0.0)));
  EXPECT_TRUE(store.entries()
                  .at({"a", "locked", 0})
                  .T_fixed_header->translation()
                  .isApprox(Eigen::Vector3d(2.0, 0.0, 0.0)))
      << "it follows its frame, with the latest transform";
}

using Eigen::Isometry3d;
using Eigen::Vector3d;

const char kFont[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
const std::string kJaw = "file://" ORGAN_COLLISION_TEST_DATA "/tools/jaw.obj";

/// The camera's axes are turned, so that no axis of a marker is one of the picture.
Eigen::Matrix3d axes() {
  return Eigen::Quaterniond(0.7, -0.3, 0.5, 0.2).normalized().toRotationMatrix();
}

Isometry3d header_pose() {
  return Eigen::Translation3d(0.4, -0.2, 0.3) *
         Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized();
}

Marker marker(int type) {
  Marker marker;
  marker.type = type;
  marker.pose.position.x = 0.1;
  marker.pose.orientation.z = 1.0;  // half a turn
  marker.scale.x = 0.2;
  marker.scale.y = 0.3;
  marker.scale.z = 0.4;
  marker.color.r = 1.0;
  marker.color.a = 0.5;
  marker.text = "Text";
  marker.mesh_resource = kJaw;
  return marker;
}

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point result;
  result.x = x;
  result.y = y;
  result.z = z;
  return result;
}

std_msgs::ColorRGBA colour(double r, double g, double b, double a) {
  std_msgs::ColorRGBA result;
  result.r = r;
  result.g = g;
  result.b = b;
  result.a = a;
  return result;
}

Marker list(int type, int count) {
  Marker result = marker(type);
  for (int i = 0; i < count; ++i) {
    result.points.push_back(point(0.1 * i, 0.05 * i * i, 0.02 * (i % 2)));
  }
  return result;
}

PictureTriangles drawn(const Marker& marker) {
  MarkerPicture picture(axes(), kFont);
  PictureTriangles triangles;
  picture.add(marker, header_pose(), triangles);
  EXPECT_EQ(triangles.size() % 3, 0u);
  return triangles;
}

/// A vertex in the frame of the marker() above.
Vector3d in_marker(const PictureVertex& vertex) {
  const Vector3d in_header = header_pose().inverse() * vertex.position - Vector3d(0.1, 0.0, 0.0);
  return {-in_header.x(), -in_header.y(), in_header.z()};
}

Eigen::AlignedBox3d box(const PictureTriangles& triangles) {
  Eigen::AlignedBox3d result;
  for (const PictureVertex& vertex : triangles) result.extend(in_marker(vertex));
  return result;
}

std::string refusal(const Marker& marker) {
  try {
    drawn(marker);
  } catch (const MarkerError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MarkerPicture, SolidsHaveTheirSizeColourAndOutwardNormals) {
  for (const int type : {Marker::CUBE, Marker::SPHERE, Marker::CYLINDER}) {
    const PictureTriangles triangles = drawn(marker(type));
    EXPECT_TRUE(box(triangles).min().isApprox(Vector3d(-0.1, -0.15, -0.2), 1e-9)) << type;
    EXPECT_TRUE(box(triangles).max().isApprox(Vector3d(0.1, 0.15, 0.2), 1e-9)) << type;
    const Vector3d centre = header_pose() * Vector3d(0.1, 0.0, 0.0);
    for (const PictureVertex& vertex : triangles) {
      EXPECT_EQ(vertex.colour, Colour(1, 0, 0, 0.5F));
      EXPECT_NEAR(vertex.normal.norm(), 1.0, 1e-9);
      EXPECT_GT(vertex.normal.dot(vertex.position - centre), 0.0);
    }
  }
}

TEST(MarkerPicture, SolidsStayOutwardIfTheirScaleMirrors) {
  Marker mirrored = marker(Marker::SPHERE);
  mirrored.scale.x = -0.2;
  const Vector3d centre = header_pose() * Vector3d(0.1, 0.0, 0.0);
  for (const PictureVertex& vertex : drawn(mirrored)) {
    EXPECT_GT(vertex.normal.dot(vertex.position - centre), 0.0);
  }
}

TEST(MarkerPicture, AnArrowGoesAlongXOrFromPointToPoint) {
  EXPECT_TRUE(box(drawn(marker(Marker::ARROW))).min().isApprox(Vector3d(0.0, -0.3, -0.4), 1e-9));
  EXPECT_TRUE(box(drawn(marker(Marker::ARROW))).max().isApprox(Vector3d(0.2, 0.3, 0.4), 1e-9));

  Marker arrow = marker(Marker::ARROW);
  arrow.points = {point(0.0, 0.0, 0.5), point(0.0, 0.0, -0.5)};
  arrow.scale.x = 0.02;
  arrow.scale.y = 0.06;
  arrow.scale.z = 0.1;
  EXPECT_TRUE(box(drawn(arrow)).min().isApprox(Vector3d(-0.03, -0.03, -0.5), 1e-9));
  EXPECT_TRUE(box(drawn(arrow)).max().isApprox(Vector3d(0.03, 0.03, 0.5), 1e-9));
  arrow.points[1] = arrow.points[0];
  EXPECT_TRUE(drawn(arrow).empty());
  arrow.points.pop_back();
  EXPECT_EQ(refusal(arrow), "it has 1 points; must be 0 or 2");
}

TEST(MarkerPicture, TrianglesWithOneColourAreLit) {
  const PictureTriangles triangles = drawn(list(Marker::TRIANGLE_LIST, 6));
  ASSERT_EQ(triangles.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    const Vector3d expected(0.2 * 0.1 * i, 0.3 * 0.05 * i * i, 0.4 * 0.02 * (i % 2));
    EXPECT_TRUE(in_marker(triangles[i]).isApprox(expected, 1e-9) || i == 0);
    EXPECT_NEAR(triangles[i].normal.norm(), 1.0, 1e-9);
  }
}

TEST(MarkerPicture, TrianglesWithColoursShowThemWithoutLight) {
  Marker triangles = list(Marker::TRIANGLE_LIST, 6);
  for (int i = 0; i < 6; ++i) triangles.colors.push_back(colour(0.1 * i, 0.5, 0.25, 1.0));
  const PictureTriangles of_vertices = drawn(triangles);
  for (int i = 0; i < 6; ++i) {
    EXPECT_TRUE(of_vertices[i].colour.isApprox(Colour(0.1F * i, 0.5F, 0.25F, 1.0F)));
    EXPECT_TRUE(of_vertices[i].normal.isZero(0.0));
  }
  triangles.colors.resize(2);
  const PictureTriangles of_faces = drawn(triangles);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(of_faces[i].colour.x(), i < 3 ? 0.0F : 0.1F, 1e-6F);
  triangles.colors.resize(4, colour(0, 0, 0, 1));
  EXPECT_EQ(refusal(triangles), "it has 4 colours for 6 points");
}

TEST(MarkerPicture, LinesHaveTheirWidthAndFaceTheViewer) {
  for (const auto& [type, lines] : {std::pair(Marker::LINE_STRIP, 3), {Marker::LINE_LIST, 2}}) {
    const PictureTriangles triangles = drawn(list(type, 4));
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

TEST(MarkerPicture, PointsAreSquaresThatFaceTheViewer) {
  const PictureTriangles triangles = drawn(list(Marker::POINTS, 3));
  ASSERT_EQ(triangles.size(), 18u);
  for (int point = 0; point < 3; ++point) {
    Eigen::AlignedBox3d box;
    for (int i = 0; i < 6; ++i) {
      box.extend(axes().transpose() * triangles[6 * point + i].position);
    }
    EXPECT_TRUE(box.sizes().isApprox(Vector3d(0.2, 0.3, 0.0), 1e-9));
  }
}

TEST(MarkerPicture, ListsOfSolidsHaveOneAtEachPoint) {
  for (const int type : {Marker::SPHERE_LIST, Marker::CUBE_LIST}) {
    const PictureTriangles one = drawn(list(type, 1)), three = drawn(list(type, 3));
    EXPECT_EQ(three.size(), 3 * one.size());
    EXPECT_TRUE(box(three).max().isApprox(Vector3d(0.3, 0.35, 0.22), 1e-9) ||
                box(three).max().isApprox(Vector3d(0.3, 0.35, 0.2), 1e-9));
  }
}

TEST(MarkerPicture, ATextFacesTheViewerAndIsAsHighAsItsScale) {
  Marker text = marker(Marker::TEXT_VIEW_FACING);
  text.text = "H";
  Eigen::AlignedBox3d box;
  for (const PictureVertex& vertex : drawn(text)) {
    box.extend(axes().transpose() * vertex.position);
    EXPECT_LE(vertex.colour.w(), 0.5F);
    EXPECT_TRUE(vertex.normal.isZero(0.0));
  }
  EXPECT_NEAR(box.sizes().y(), 0.4, 0.02);
  EXPECT_NEAR(box.sizes().z(), 0.0, 1e-9);
  const Vector3d centre = axes().transpose() * (header_pose() * Vector3d(0.1, 0.0, 0.0));
  EXPECT_LT((box.center() - centre).norm(), 0.02);
}

TEST(MarkerPicture, AMeshFileIsShownWithItsScale) {
  Marker mesh = marker(Marker::MESH_RESOURCE);
  const Eigen::AlignedBox3d once = box(drawn(mesh));
  EXPECT_GT(once.volume(), 0.0);
  mesh.scale.x *= 2.0;
  EXPECT_NEAR(box(drawn(mesh)).sizes().x(), 2.0 * once.sizes().x(), 1e-9);
  mesh.mesh_resource = "http://example.com/jaw.obj";
  EXPECT_NE(refusal(mesh).find("package:// or file://"), std::string::npos) << refusal(mesh);
}

TEST(MarkerPicture, IllegalMarkersAreRefusedAndAddNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Marker bad = list(Marker::POINTS, 3);
  bad.points[2].y = kNan;
  EXPECT_EQ(refusal(bad), "point 2 is not finite");
  bad = marker(Marker::CUBE);
  bad.pose.orientation.x = kNan;
  EXPECT_EQ(refusal(bad), "its pose or scale is not finite");
  bad = marker(Marker::CUBE);
  bad.color.g = static_cast<float>(kNan);
  EXPECT_EQ(refusal(bad), "a colour is not finite");
  EXPECT_EQ(refusal(list(Marker::TRIANGLE_LIST, 4)), "it has 4 points; must be a multiple of 3");
  EXPECT_EQ(refusal(list(Marker::LINE_LIST, 3)), "it has 3 points; must be a multiple of 2");
  EXPECT_EQ(refusal(marker(77)), "its type 77 is unknown");

  MarkerPicture picture(axes(), "/no/such.ttf");
  PictureTriangles triangles;
  EXPECT_THROW(picture.add(marker(Marker::TEXT_VIEW_FACING), header_pose(), triangles),
               MarkerError);
  EXPECT_TRUE(triangles.empty());
}

TEST(MarkerPicture, EmptyListsAndZeroOrientationsAreLegal) {
  for (const int type : {Marker::TRIANGLE_LIST, Marker::LINE_LIST, Marker::LINE_STRIP,
                         Marker::POINTS, Marker::SPHERE_LIST, Marker::CUBE_LIST}) {
    EXPECT_TRUE(drawn(list(type, 0)).empty());
  }
  Marker upright = marker(Marker::CUBE);
  upright.pose.orientation.z = 0.0;
  EXPECT_EQ(drawn(upright).size(), 36u);
}

}  // namespace

}  // namespace organ_collision
