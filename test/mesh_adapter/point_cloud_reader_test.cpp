#include "mesh_adapter/point_cloud_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "clouds.hpp"
#include "refusal.hpp"

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

}  // namespace
}  // namespace organ_collision
