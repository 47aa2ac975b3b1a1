#include "mesh_adapter/surface_messages.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>
#include <limits>
#include <random>

#include "ros/messages/conversions.hpp"
#include "surface_messages.hpp"

TEST(ReceivedSurface, IsEmptyWithoutVerticesAndTriangles) {
  organ_collision::ReceivedSurface surface;
  surface.frame = "liver";
  EXPECT_TRUE(surface.empty());
  surface.triangles = {0, 1, 2};
  EXPECT_FALSE(surface.empty());
  surface.triangles.clear();
  surface.vertices = {0.1f, 0.2f, 0.3f};
  EXPECT_FALSE(surface.empty());
}

TEST(MessageError, HasReasonAndMessage) {
  const organ_collision::MessageError error("truncated cloud", "data has 3 bytes");
  EXPECT_EQ(error.reason(), "truncated cloud");
  EXPECT_STREQ(error.what(), "data has 3 bytes");
}

namespace organ_collision {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

constexpr std::uint8_t kDouble = PointField::FLOAT64;

/// Random coordinates as multiples of 2^-40. Most of them are not exact as 32-bit floats.
std::vector<double> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-0.3, 0.3);
  std::vector<double> points(3 * count);
  for (double& value : points) value = std::round(std::ldexp(coordinate(random), 40)) * 0x1p-40;
  return points;
}

std::vector<float> floats(const std::vector<double>& numbers) {
  return {numbers.begin(), numbers.end()};
}

std::vector<float> read(const PointCloud2& cloud) {
  std::vector<float> vertices = {4.0f, 5.0f};
  read_points(cloud, vertices);
  return vertices;
}

std::string refusal_of(const PointCloud2& cloud) {
  return refusal([&] { read(cloud); });
}

TEST(PointCloudReader, ReadsEveryLayout) {
  const std::vector<CloudLayout> layouts = {
      kPackedFloats,
      {{{"z"}, {"x"}, {"y"}}},
      {{{"x"}, {"y"}, {"z"}, {""}, {"rgb"}, {""}, {""}, {""}}},  // PCL's PointXYZRGB
      {{{"", PointField::UINT8},
        {"y"},
        {"intensity", PointField::UINT16},
        {"z"},
        {"", PointField::UINT8},
        {"x"}}},
      {{{"x", kDouble}, {"y", kDouble}, {"z", kDouble}}},
      {{{"time", kDouble}, {"y", kDouble}, {"x"}, {"z", kDouble}, {"ring", PointField::INT8}}},
  };
  const std::vector<double> points = random_points(60, 7);
  for (CloudLayout layout : layouts) {
    for (const bool big_endian : {false, true}) {
      for (const std::uint32_t width : {0, 1, 12, 60}) {
        for (const std::uint32_t row_padding : {0, 5}) {
          layout.big_endian = big_endian;
          layout.width = width;
          layout.row_padding = row_padding;
          EXPECT_EQ(read(cloud_of(points, layout)), floats(points))
              << layout.fields[0].name << " first, big endian " << big_endian << ", width " << width
              << ", row padding " << row_padding;
        }
      }
    }
  }
}

TEST(PointCloudReader, TakesWhatIsLooselyFilledIn) {
  const std::vector<double> points = random_points(4, 8);
  PointCloud2 cloud = cloud_of(points);
  cloud.row_step = 0;  // Not used if there is only one row.
  for (PointField& field : cloud.fields) field.count = 0;
  cloud.data.resize(cloud.data.size() + 7);
  EXPECT_EQ(read(cloud), floats(points));

  cloud = cloud_of(points, {{{"x"}, {"y"}, {"z"}}, false, 2, 8});
  cloud.data.resize(cloud.data.size() - 8);  // The last row needs no padding.
  EXPECT_EQ(read(cloud), floats(points));
}

TEST(PointCloudReader, NumbersNeedNotBeFinite) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const std::uint8_t datatype : {PointField::FLOAT32, PointField::FLOAT64}) {
    const CloudLayout layout{{{"x", datatype}, {"y", datatype}, {"z", datatype}}};
    const std::vector<float> vertices = read(cloud_of({nan, infinity, -infinity}, layout));
    EXPECT_TRUE(std::isnan(vertices[0]));
    EXPECT_EQ(vertices[1], infinity);
    EXPECT_EQ(vertices[2], -infinity);
  }
}

TEST(PointCloudReader, NoPointsAreNoVertices) {
  EXPECT_TRUE(read(PointCloud2()).empty());
  PointCloud2 flat;
  flat.height = 1;
  flat.row_step = 16;
  EXPECT_TRUE(read(flat).empty());
}

TEST(PointCloudReader, RefusesFieldsThatAreNoCoordinates) {
  PointCloud2 cloud = cloud_of({0.1, 0.2, 0.3}, {{{"x"}, {"y"}, {"intensity"}}});
  expect_words(refusal_of(cloud), {"missing field: ", "'x, y, intensity'", "x, y and z"});
  cloud.fields.clear();
  expect_words(refusal_of(cloud), {"missing field: ", "''"});

  cloud = cloud_of({0.1, 0.2, 0.3});
  for (const int datatype : {0, 1, 2, 3, 4, 5, 6, 9, 255}) {
    cloud.fields[1].datatype = static_cast<std::uint8_t>(datatype);
    expect_words(refusal_of(cloud), {"wrong field type: ", "field y",
                                     "datatype " + std::to_string(datatype), "7", "8"});
  }
  cloud.fields[1].datatype = PointField::FLOAT32;
  cloud.fields[2].count = 3;
  expect_words(refusal_of(cloud), {"wrong field count: ", "field z", "count 3", "1"});
}

TEST(PointCloudReader, RefusesFieldsBeyondThePoint) {
  PointCloud2 cloud = cloud_of({0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  cloud.fields[2].offset = 9;
  expect_words(refusal_of(cloud), {"wrong point_step: ", "field z", "byte 13", "is 12"});
  cloud.fields[2].offset = 4294967295;
  expect_words(refusal_of(cloud), {"wrong point_step: ", "byte 4294967299", "is 12"});
  cloud.fields[2].offset = 8;
  cloud.fields[2].datatype = PointField::FLOAT64;
  expect_words(refusal_of(cloud), {"wrong point_step: ", "byte 16", "is 12"});
  cloud.fields[2].datatype = PointField::FLOAT32;
  cloud.point_step = 0;
  expect_words(refusal_of(cloud), {"wrong point_step: ", "field x", "is 0"});
}

TEST(PointCloudReader, RefusesTooFewBytes) {
  const PointCloud2 good = cloud_of(random_points(6, 9), {{{"x"}, {"y"}, {"z"}}, false, 3});
  PointCloud2 cloud = good;
  cloud.data.pop_back();
  expect_words(refusal_of(cloud), {"truncated cloud: ", "71 bytes", "3 x 2", "point_step 12"});
  cloud.data.clear();
  expect_words(refusal_of(cloud), {"truncated cloud: ", "0 bytes"});
  cloud = good;
  cloud.point_step = 13;
  expect_words(refusal_of(cloud), {"wrong row_step: ", "36", "3 points", "39"});
  cloud = good;
  cloud.row_step = 37;
  expect_words(refusal_of(cloud), {"truncated cloud: ", "72 bytes"});
}

TEST(PointCloudReader, RefusesSizesWhoseBytesOverflow) {
  constexpr std::uint32_t kMost = 4294967295;
  const PointCloud2 good = cloud_of(random_points(6, 9));
  for (const std::uint32_t width : {6u, kMost}) {
    for (const std::uint32_t height : {1u, 2u, kMost}) {
      for (const std::uint32_t point_step : {12u, 0x80000000u, kMost}) {
        for (const std::uint32_t row_step : {72u, 0x80000000u, kMost}) {
          PointCloud2 cloud = good;
          cloud.width = width;
          cloud.height = height;
          cloud.point_step = point_step;
          cloud.row_step = row_step;
          const bool legal = width == 6 && height == 1 && point_step == 12;
          EXPECT_EQ(refusal_of(cloud) == "accepted", legal)
              << width << " x " << height << ", " << point_step << ", " << row_step;
        }
      }
    }
  }
}

TEST(PointCloudReader, RefusesDataOfNoPoints) {
  PointCloud2 cloud = cloud_of({0.1, 0.2, 0.3});
  cloud.width = 0;
  expect_words(refusal_of(cloud), {"wrong size: ", "0 x 1"});
  cloud.width = 1;
  cloud.height = 0;
  expect_words(refusal_of(cloud), {"wrong size: ", "1 x 0"});
}

using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;

/// A surface with the content of an earlier message.
ReceivedSurface used_surface() {
  return {"table", ros::Time(3), {1.0f, 2.0f, 3.0f, 4.0f}, {7, 8, 9, 10}};
}

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  return point;
}

shape_msgs::MeshTriangle triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  shape_msgs::MeshTriangle triangle;
  triangle.vertex_indices = {a, b, c};
  return triangle;
}

pcl_msgs::Vertices polygon(const Indices& corners) {
  pcl_msgs::Vertices polygon;
  polygon.vertices = corners;
  return polygon;
}

TEST(MeshConversions, TakesAShapeMeshAsItIs) {
  shape_msgs::Mesh mesh;
  mesh.vertices = {point(0.1, -0.2, 0.3), point(std::nan(""), 5.5, 1e30), point(0.7, 0.8, 0.9)};
  mesh.triangles = {triangle(2, 0, 1), triangle(1, 1, 4000)};
  ReceivedSurface surface = used_surface();
  convert(mesh, surface);
  EXPECT_EQ(surface.frame, "");
  EXPECT_TRUE(surface.stamp.isZero());
  ASSERT_EQ(surface.vertices.size(), 9u);
  EXPECT_TRUE(std::isnan(surface.vertices[3]));
  surface.vertices[3] = 0.0f;
  EXPECT_EQ(surface.vertices, (Floats{0.1f, -0.2f, 0.3f, 0.0f, 5.5f, 1e30f, 0.7f, 0.8f, 0.9f}));
  EXPECT_EQ(surface.triangles, (Indices{2, 0, 1, 1, 1, 4000}));
}

TEST(MeshConversions, AnEmptyMeshIsAnEmptySurface) {
  ReceivedSurface surface = used_surface();
  convert(shape_msgs::Mesh(), surface);
  EXPECT_TRUE(surface.empty());
  surface = used_surface();
  convert(pcl_msgs::PolygonMesh(), surface);
  EXPECT_TRUE(surface.empty());
}

class PolygonMeshTest : public testing::Test {
 protected:
  PolygonMeshTest() {
    mesh_.cloud = cloud_of({0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, {{{"z"}, {"y"}, {"x"}}, true});
    mesh_.polygons = {polygon({3, 1, 2})};
  }

  ReceivedSurface converted() const {
    ReceivedSurface surface = used_surface();
    convert(mesh_, surface);
    return surface;
  }

  pcl_msgs::PolygonMesh mesh_;
};

TEST_F(PolygonMeshTest, VerticesAreThePointsOfTheCloud) {
  EXPECT_EQ(converted().vertices, (Floats{0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}));
}

TEST_F(PolygonMeshTest, PolygonsAreFans) {
  mesh_.polygons = {polygon({3, 1, 2}), polygon({9, 8, 7, 6, 5}), polygon({0, 0, 4, 0})};
  EXPECT_EQ(converted().triangles, (Indices{3, 1, 2, 9, 8, 7, 9, 7, 6, 9, 6, 5, 0, 0, 4, 0, 4, 0}));
}

TEST_F(PolygonMeshTest, RefusesPolygonsOfFewerThanThreeCorners) {
  for (const Indices& corners : {Indices{}, Indices{1}, Indices{1, 0}}) {
    mesh_.polygons = {polygon({3, 1, 2}), polygon(corners)};
    expect_words(refusal([&] { converted(); }),
                 {"polygon without area: ", "polygon 1 ",
                  std::to_string(corners.size()) + " corners", "at least 3"});
  }
}

TEST_F(PolygonMeshTest, RefusesAnUnreadableCloud) {
  mesh_.cloud.data.pop_back();
  expect_words(refusal([&] { converted(); }), {"truncated cloud: "});
}

TEST_F(PolygonMeshTest, FrameAndStampAreTheMeshsOwnElseTheClouds) {
  mesh_.cloud.header.frame_id = "camera";
  mesh_.cloud.header.stamp = ros::Time(5.5);
  EXPECT_EQ(converted().frame, "camera");
  EXPECT_EQ(converted().stamp, ros::Time(5.5));
  mesh_.header.frame_id = "liver";
  EXPECT_EQ(converted().frame, "liver");
  EXPECT_EQ(converted().stamp, ros::Time(5.5));
  mesh_.header.stamp = ros::Time(6.5);
  EXPECT_EQ(converted().stamp, ros::Time(6.5));
}

using visualization_msgs::Marker;

class MarkerReaderTest : public testing::Test {
 protected:
  MarkerReaderTest() {
    marker_.header.frame_id = "liver";
    marker_.header.stamp = ros::Time(7.25);
    marker_.ns = "organs";
    marker_.id = 3;
    marker_.type = Marker::TRIANGLE_LIST;
    marker_.scale = to_vector({1.0, 1.0, 1.0});
    marker_.pose.orientation.w = 1.0;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> coordinate(-0.2, 0.2);
    for (int i = 0; i < 6; ++i) {
      marker_.points.push_back(
          tf2::toMsg(Eigen::Vector3d(coordinate(random), coordinate(random), coordinate(random))));
    }
  }

  ReceivedSurface read() { return read(marker_); }
  ReceivedSurface read(const Marker& marker) {
    ReceivedSurface surface{"table", ros::Time(3), {1.0f, 2.0f}, {9}};
    reader_.read(marker, surface);
    reader_.keep();
    return surface;
  }
  std::string refusal_now() {
    return refusal([&] { read(); });
  }

  Marker marker_;
  MarkerReader reader_;
};

TEST_F(MarkerReaderTest, ThreePointsAreAFace) {
  const ReceivedSurface surface = read();
  EXPECT_EQ(surface.frame, "liver");
  EXPECT_EQ(surface.stamp, ros::Time(7.25));
  EXPECT_EQ(surface.triangles, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  ASSERT_EQ(surface.vertices.size(), 18u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(surface.vertices[3 * i], static_cast<float>(marker_.points[i].x));
    EXPECT_EQ(surface.vertices[3 * i + 1], static_cast<float>(marker_.points[i].y));
    EXPECT_EQ(surface.vertices[3 * i + 2], static_cast<float>(marker_.points[i].z));
  }
}

TEST_F(MarkerReaderTest, ScaleComesBeforePose) {
  marker_.scale = to_vector({2.0, 0.5, 3.0});
  marker_.pose.position = tf2::toMsg(Eigen::Vector3d(0.4, -0.3, 0.2));
  marker_.pose.orientation.w = marker_.pose.orientation.z =
      std::sqrt(0.5);  // maps x to y, and y to -x
  const ReceivedSurface surface = read();
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(surface.vertices[3 * i], 0.4 - 0.5 * marker_.points[i].y, 1e-7);
    EXPECT_NEAR(surface.vertices[3 * i + 1], -0.3 + 2.0 * marker_.points[i].x, 1e-7);
    EXPECT_NEAR(surface.vertices[3 * i + 2], 0.2 + 3.0 * marker_.points[i].z, 1e-7);
  }
}

TEST_F(MarkerReaderTest, AnOrientationIsNormalisedOrNone) {
  const std::vector<float> vertices = read().vertices;
  marker_.pose.orientation.w = 0.995;
  EXPECT_EQ(read().vertices, vertices);
  marker_.pose.orientation.w = 0.0;
  EXPECT_EQ(read().vertices, vertices);
  marker_.pose.orientation.x = 2.0;
  expect_words(refusal_now(), {"wrong orientation: ", "length 2", "must be 1"});
  marker_.pose.orientation.x = std::nan("");
  expect_words(refusal_now(), {"wrong orientation: ", "nan"});
}

TEST_F(MarkerReaderTest, RefusesAScaleThatLeavesNoSurface) {
  for (const double factor : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    marker_.scale.y = factor;
    expect_words(refusal_now(), {"wrong scale: ", "1", "finite and more than 0"});
  }
}

TEST_F(MarkerReaderTest, RefusesAnIncompleteFace) {
  marker_.points.pop_back();
  expect_words(refusal_now(), {"wrong number of points: ", "'organs/3'", "5 points", "three"});
}

TEST_F(MarkerReaderTest, RefusesOtherTypesByName) {
  marker_.type = Marker::TEXT_VIEW_FACING;
  expect_words(refusal_now(),
               {"other marker type: ", "'organs/3'", "9 (TEXT_VIEW_FACING)", "11 (TRIANGLE_LIST)"});
  for (const int type : {-5, 12, 1000}) {
    marker_.type = type;
    expect_words(refusal_now(), {std::to_string(type) + " (unknown)"});
  }
}

TEST_F(MarkerReaderTest, TheFirstTriangleListIsTheOrganUntilItIsDeleted) {
  Marker arrow = marker_;
  arrow.id = 2;
  arrow.type = Marker::ARROW;
  EXPECT_THROW(read(arrow), MessageError);
  EXPECT_FALSE(read().empty());

  Marker other = marker_;
  other.ns = "tools";
  expect_words(refusal([&] { read(other); }), {"other marker: ", "'tools/3'", "'organs/3'"});
  other.action = Marker::DELETE;
  expect_words(refusal([&] { read(other); }), {"other marker: "});
  other.ns = std::string(10'000'000, 'x');
  const std::string illegal = refusal([&] { read(other); });
  expect_words(illegal, {"illegal name: ", "namespace 'xxx", "at most 256 bytes"});
  EXPECT_LT(illegal.size(), 1000u);
  other.ns = marker_.ns;
  other.id = 4;
  expect_words(refusal([&] { read(other); }), {"other marker: ", "'organs/4'"});

  marker_.action = Marker::DELETE;
  EXPECT_TRUE(read().empty());
  other.action = Marker::ADD;
  EXPECT_FALSE(read(other).empty());
}

TEST_F(MarkerReaderTest, DeleteAllRemovesWhateverItsName) {
  read();
  Marker all;
  all.action = Marker::DELETEALL;
  EXPECT_TRUE(read(all).empty());
  marker_.ns = "anew";
  EXPECT_FALSE(read().empty());
}

TEST_F(MarkerReaderTest, WithoutPointsItIsEmptyAndKeepsItsName) {
  Marker empty = marker_;
  empty.points.clear();
  EXPECT_TRUE(read(empty).empty());
  marker_.id = 4;
  expect_words(refusal_now(), {"other marker: "});
}

TEST_F(MarkerReaderTest, RefusesUnknownActions) {
  marker_.action = 7;
  expect_words(refusal_now(), {"unknown action: ", "'organs/3'", "action 7", "0 (ADD)"});
}

}  // namespace

}  // namespace organ_collision
