#include "adapters/surface_messages.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "common/messages/conversions.hpp"
#include "surface_messages.hpp"

namespace organ_collision {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;
using visualization_msgs::Marker;
using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;

const double kNan = std::nan(""), kInfinity = std::numeric_limits<double>::infinity();

/// A message that is spoiled, and words of its refusal. The first is its reason.
template <typename Message>
struct Refusal {
  std::function<void(Message& message)> spoil;
  std::vector<std::string> words;
};

/// Random coordinates as multiples of 2^-40. Most of them are not exact as 32-bit floats.
std::vector<double> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-0.3, 0.3);
  std::vector<double> points(3 * count);
  for (double& value : points) value = std::round(std::ldexp(coordinate(random), 40)) * 0x1p-40;
  return points;
}

Floats floats(const std::vector<double>& numbers) { return {numbers.begin(), numbers.end()}; }

TEST(PointCloudReader, ReadsEveryLayout) {
  constexpr std::uint8_t kDouble = PointField::FLOAT64;
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
          EXPECT_EQ(read_points(cloud_of(points, layout)), floats(points))
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
  EXPECT_EQ(read_points(cloud), floats(points));
  cloud = cloud_of(points, {{{"x"}, {"y"}, {"z"}}, false, 2, 8});
  cloud.data.resize(cloud.data.size() - 8);  // The last row needs no padding.
  EXPECT_EQ(read_points(cloud), floats(points));
  cloud = PointCloud2();
  EXPECT_TRUE(read_points(cloud).empty());
  cloud.height = 1;
  cloud.row_step = 16;
  EXPECT_TRUE(read_points(cloud).empty());
}

TEST(PointCloudReader, RefusesWhatIsNoCloudOfPoints) {
  const PointCloud2 good = cloud_of(random_points(6, 9), {{{"x"}, {"y"}, {"z"}}, false, 3});
  std::vector<Refusal<PointCloud2>> rows = {
      {[](auto& c) { c.fields[2].name = "intensity"; },
       {"missing field: ", "'x, y, intensity'", "x, y and z"}},
      {[](auto& c) { c.fields.clear(); }, {"missing field: ", "''"}},
      {[](auto& c) { c.fields[2].count = 3; }, {"wrong field count: ", "field z", "count 3", "1"}},
      {[](auto& c) { c.fields[2].offset = 9; },
       {"wrong point_step: ", "field z", "byte 13", "is 12"}},
      {[](auto& c) { c.fields[2].offset = 4294967295; },
       {"wrong point_step: ", "byte 4294967299", "is 12"}},
      {[](auto& c) { c.fields[2].datatype = PointField::FLOAT64; },
       {"wrong point_step: ", "byte 16", "is 12"}},
      {[](auto& c) { c.point_step = 0; }, {"wrong point_step: ", "field x", "is 0"}},
      {[](auto& c) { c.data.pop_back(); },
       {"truncated cloud: ", "71 bytes", "3 x 2", "point_step 12"}},
      {[](auto& c) { c.data.clear(); }, {"truncated cloud: ", "0 bytes"}},
      {[](auto& c) { c.point_step = 13; }, {"wrong row_step: ", "36", "3 points", "39"}},
      {[](auto& c) { c.row_step = 37; }, {"truncated cloud: ", "72 bytes"}},
      {[](auto& c) { c.width = 0; }, {"wrong size: ", "0 x 2"}},
      {[](auto& c) { c.height = 0; }, {"wrong size: ", "3 x 0"}},
  };
  for (const int datatype : {0, 1, 2, 3, 4, 5, 6, 9, 255}) {
    rows.push_back({[datatype](auto& c) { c.fields[1].datatype = datatype; },
                    {"wrong field type: ", "field y", "datatype " + std::to_string(datatype)}});
  }
  for (const auto& row : rows) {
    PointCloud2 cloud = good;
    row.spoil(cloud);
    expect_words(refusal([&] { read_points(cloud); }), row.words);
  }
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
          EXPECT_EQ(refusal([&] { read_points(cloud); }) == "accepted", legal)
              << width << " x " << height << ", " << point_step << ", " << row_step;
        }
      }
    }
  }
}

/// The refusals of all messages that can have these points, as multiples of three.
std::vector<std::string> refusals_of(const std::vector<double>& points) {
  constexpr std::uint8_t kDouble = PointField::FLOAT64;
  std::vector<std::string> refusals;
  pcl_msgs::PolygonMesh polygons;
  for (const bool big_endian : {false, true}) {
    for (const std::uint8_t type : {PointField::FLOAT32 + 0, kDouble + 0}) {
      const CloudLayout layout{{{"z", type}, {"", type}, {"x", type}, {"y", type}}, big_endian, 3};
      polygons.cloud = cloud_of(points, layout);
      refusals.push_back(refusal([&] { read_points(polygons.cloud); }));
      refusals.push_back(refusal([&] { convert(polygons); }));
    }
  }
  shape_msgs::Mesh mesh;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    mesh.vertices.push_back(tf2::toMsg(Eigen::Vector3d(&points[i])));
  }
  refusals.push_back(refusal([&] { convert(mesh); }));
  Marker marker;
  marker.type = Marker::TRIANGLE_LIST;
  marker.scale = to_vector({1.0, 1.0, 1.0});
  marker.points = mesh.vertices;
  refusals.push_back(refusal([&] { MarkerReader().read(marker); }));
  return refusals;
}

TEST(MeshConversions, WhatIsNotFiniteAsAFloatIsRefusedWithItsPlace) {
  const std::vector<double> good = random_points(6, 12);
  for (const std::string& text : refusals_of(good)) EXPECT_EQ(text, "accepted");
  for (const double value : {kNan, kInfinity, -kInfinity, 1e39, -3.5e38}) {
    for (std::size_t place = 0; place < good.size(); ++place) {
      std::vector<double> points = good;
      points[place] = value;
      for (const std::string& text : refusals_of(points)) {
        expect_words(text, {"not finite: ",
                            std::string(1, "xyz"[place % 3]) + " of vertex " +
                                std::to_string(place / 3) + " is ",
                            "must be finite 32-bit floats"});
      }
    }
  }
  for (const double value : {3.4e38, -3.4e38, 1e-46}) {
    std::vector<double> points = good;
    points[7] = value;
    for (const std::string& text : refusals_of(points)) EXPECT_EQ(text, "accepted") << value;
  }
}

TEST(MeshConversions, TakesAShapeMeshAsItIs) {
  shape_msgs::Mesh mesh;
  for (const Eigen::Vector3d& at :
       {Eigen::Vector3d(0.1, -0.2, 0.3), Eigen::Vector3d(7.5, 5.5, 1e30)}) {
    mesh.vertices.push_back(tf2::toMsg(at));
  }
  mesh.triangles.resize(2);
  mesh.triangles[0].vertex_indices = {2, 0, 1};
  mesh.triangles[1].vertex_indices = {1, 1, 4000};
  const ReceivedSurface surface = convert(mesh);
  EXPECT_EQ(surface.frame, "");
  EXPECT_TRUE(surface.stamp.isZero());
  EXPECT_EQ(surface.vertices, (Floats{0.1f, -0.2f, 0.3f, 7.5f, 5.5f, 1e30f}));
  EXPECT_EQ(surface.triangles, (Indices{2, 0, 1, 1, 1, 4000}));
  EXPECT_TRUE(convert(shape_msgs::Mesh()).empty());
  EXPECT_TRUE(convert(pcl_msgs::PolygonMesh()).empty());
}

TEST(MeshConversions, PolygonsAreFansOfTheCloudsPoints) {
  pcl_msgs::PolygonMesh mesh;
  mesh.cloud = cloud_of({0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, {{{"z"}, {"y"}, {"x"}}, true});
  mesh.cloud.header.frame_id = "camera";
  mesh.cloud.header.stamp = ros::Time(5.5);
  mesh.polygons.resize(2);
  mesh.polygons[0].vertices = {9, 8, 7, 6, 5};
  mesh.polygons[1].vertices = {0, 0, 4, 0};
  const ReceivedSurface surface = convert(mesh);
  EXPECT_EQ(surface.vertices, (Floats{0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}));
  EXPECT_EQ(surface.triangles, (Indices{9, 8, 7, 9, 7, 6, 9, 6, 5, 0, 0, 4, 0, 4, 0}));
  EXPECT_EQ(surface.frame, "camera");
  EXPECT_EQ(surface.stamp, ros::Time(5.5));
  mesh.header.frame_id = "liver";
  mesh.header.stamp = ros::Time(6.5);
  EXPECT_EQ(convert(mesh).frame, "liver");
  EXPECT_EQ(convert(mesh).stamp, ros::Time(6.5));
  for (const Indices& corners : {Indices{}, Indices{1}, Indices{1, 0}}) {
    mesh.polygons[1].vertices = corners;
    expect_words(refusal([&] { convert(mesh); }),
                 {"polygon without area: ", "polygon 1 ",
                  std::to_string(corners.size()) + " corners", "at least 3"});
  }
  mesh.cloud.data.pop_back();
  expect_words(refusal([&] { convert(mesh); }), {"truncated cloud: "});
}

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
    const std::vector<double> points = random_points(6, 11);
    for (std::size_t i = 0; i < points.size(); i += 3) {
      marker_.points.push_back(tf2::toMsg(Eigen::Vector3d(&points[i])));
    }
  }

  ReceivedSurface read(const Marker& marker) {
    ReceivedSurface surface = reader_.read(marker);
    reader_.keep();
    return surface;
  }
  std::string refusal_of(const Marker& marker) {
    return refusal([&] { read(marker); });
  }

  Marker marker_;
  MarkerReader reader_;
};

TEST_F(MarkerReaderTest, ThreePointsAreAFaceAndScaleComesBeforePose) {
  marker_.scale = to_vector({2.0, 0.5, 3.0});
  marker_.pose.position = tf2::toMsg(Eigen::Vector3d(0.4, -0.3, 0.2));
  marker_.pose.orientation.w = marker_.pose.orientation.z =
      std::sqrt(0.5);  // maps x to y, and y to -x
  const ReceivedSurface surface = read(marker_);
  EXPECT_EQ(surface.frame, "liver");
  EXPECT_EQ(surface.stamp, ros::Time(7.25));
  EXPECT_EQ(surface.triangles, (Indices{0, 1, 2, 3, 4, 5}));
  ASSERT_EQ(surface.vertices.size(), 18u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(surface.vertices[3 * i], 0.4 - 0.5 * marker_.points[i].y, 1e-7);
    EXPECT_NEAR(surface.vertices[3 * i + 1], -0.3 + 2.0 * marker_.points[i].x, 1e-7);
    EXPECT_NEAR(surface.vertices[3 * i + 2], 0.2 + 3.0 * marker_.points[i].z, 1e-7);
  }
}

TEST_F(MarkerReaderTest, AnOrientationIsNormalisedOrNone) {
  const Floats vertices = read(marker_).vertices;
  for (const double w : {0.995, 0.0}) {
    marker_.pose.orientation.w = w;
    EXPECT_EQ(read(marker_).vertices, vertices);
  }
}

TEST_F(MarkerReaderTest, RefusesWhatIsNoSurface) {
  const std::vector<Refusal<Marker>> rows = {
      {[](auto& m) { m.pose.orientation.x = 2.0, m.pose.orientation.w = 0.0; },
       {"wrong orientation: ", "length 2", "must be 1"}},
      {[](auto& m) { m.pose.orientation.x = kNan; }, {"wrong orientation: ", "nan"}},
      {[](auto& m) { m.pose.position.y = kNan; }, {"not finite: ", "pose.position is ", "nan"}},
      {[](auto& m) { m.scale.y = 1e41; }, {"not finite: ", "y of vertex 0 is ", "e+3"}},
      {[](auto& m) { m.scale.y = 0.0; }, {"wrong scale: ", "1 0 1", "finite and more than 0"}},
      {[](auto& m) { m.scale.y = -1.0; }, {"wrong scale: "}},
      {[](auto& m) { m.scale.y = kNan; }, {"wrong scale: "}},
      {[](auto& m) { m.scale.y = kInfinity; }, {"wrong scale: "}},
      {[](auto& m) { m.points.pop_back(); },
       {"wrong number of points: ", "'organs/3'", "5 points", "three"}},
      {[](auto& m) { m.type = Marker::TEXT_VIEW_FACING; },
       {"other marker type: ", "'organs/3'", "9 (TEXT_VIEW_FACING)", "11 (TRIANGLE_LIST)"}},
      {[](auto& m) { m.type = -5; }, {"other marker type: ", "-5 (unknown)"}},
      {[](auto& m) { m.type = 12; }, {"other marker type: ", "12 (unknown)"}},
      {[](auto& m) { m.action = 7; }, {"unknown action: ", "'organs/3'", "action 7", "0 (ADD)"}},
      {[](auto& m) { m.ns.assign(10'000'000, 'x'); },
       {"illegal name: ", "namespace 'xxx", "at most 256 bytes"}},
  };
  for (const auto& row : rows) {
    Marker marker = marker_;
    row.spoil(marker);
    const std::string text = refusal_of(marker);
    expect_words(text, row.words);
    EXPECT_LT(text.size(), 1000u);
  }
}

TEST_F(MarkerReaderTest, TheFirstTriangleListIsTheOrganUntilItIsDeleted) {
  Marker arrow = marker_, empty = marker_, other = marker_;
  arrow.id = 2;
  arrow.type = Marker::ARROW;
  EXPECT_THROW(read(arrow), MessageError);
  empty.points.clear();  // It keeps its name.
  EXPECT_TRUE(read(empty).empty());
  EXPECT_FALSE(read(marker_).empty());
  other.ns = "tools";
  for (const int action : {Marker::ADD, Marker::DELETE}) {
    other.action = action;
    expect_words(refusal_of(other), {"other marker: ", "'tools/3'", "'organs/3'"});
  }
  other.ns = marker_.ns;
  other.id = 4;
  expect_words(refusal_of(other), {"other marker: ", "'organs/4'"});

  marker_.action = Marker::DELETE;
  EXPECT_TRUE(read(marker_).empty());
  other.action = Marker::ADD;
  EXPECT_FALSE(read(other).empty());
  Marker all;
  all.action = Marker::DELETEALL;  // Whatever its name.
  EXPECT_TRUE(read(all).empty());
  marker_.action = Marker::ADD;
  EXPECT_FALSE(read(marker_).empty());
}

}  // namespace
}  // namespace organ_collision
