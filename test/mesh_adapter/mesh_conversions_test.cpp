#include "mesh_adapter/mesh_conversions.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "clouds.hpp"
#include "refusal.hpp"

namespace organ_collision {
namespace {

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

}  // namespace
}  // namespace organ_collision
