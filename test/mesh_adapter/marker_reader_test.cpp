#include "mesh_adapter/marker_reader.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>
#include <limits>
#include <random>

#include "refusal.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

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
