#include "mesh_adapter/organ_source.hpp"

#include <gtest/gtest.h>
#include <pcl_msgs/PolygonMesh.h>
#include <shape_msgs/Mesh.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>

#include "ros/messages/conversions.hpp"
#include "surface_messages.hpp"
#include "test/grid_surface.hpp"

namespace organ_collision {
namespace {

using topic_tools::ShapeShifter;

/// The message as a subscriber receives it, without its last `cut` bytes.
template <typename Message>
ShapeShifter shape_shifter(const Message& message, std::uint32_t cut = 0) {
  namespace traits = ros::message_traits;
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  ShapeShifter shifter;
  shifter.morph(traits::md5sum<Message>(), traits::datatype<Message>(),
                traits::definition<Message>(), "0");
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()) - cut);
  shifter.read(in);
  return shifter;
}

constexpr std::uint32_t kLastTopology = 4294967294;  // The second mesh's wraps to 0.

/// Keeps what the source sent in the last call: `mesh_` or `vertices_`. The other one is null.
class OrganSourceTest : public testing::Test {
 protected:
  void send(const GridSurface& grid, const std::string& frame = "liver") {
    pcl_msgs::PolygonMesh message;
    message.cloud = cloud_of({grid.vertices.begin(), grid.vertices.end()});
    for (const FaceIndices& face : grid.faces) {
      message.polygons.emplace_back();
      message.polygons.back().vertices.assign(face.begin(), face.end());
    }
    message.header.frame_id = frame;
    message.header.stamp = stamp_ += ros::Duration(0.01);
    mesh_.reset();
    vertices_.reset();
    source_.take_surface(shape_shifter(message), {});
    ASSERT_NE(mesh_ == nullptr, vertices_ == nullptr);
  }
  void send_vertices(const std::vector<float>& vertices, const std::string& frame = "liver") {
    sensor_msgs::PointCloud2 message = cloud_of({vertices.begin(), vertices.end()});
    message.header.frame_id = frame;
    message.header.stamp = stamp_ += ros::Duration(0.01);
    mesh_.reset();
    vertices_.reset();
    source_.take_vertices(shape_shifter(message), {});
    ASSERT_TRUE(vertices_);
  }

  template <typename Message>
  void expect(const boost::shared_ptr<Message>& message, std::uint32_t revision,
              const std::vector<float>& vertices) {
    ASSERT_TRUE(message);
    EXPECT_EQ(message->organ, "organ");
    EXPECT_EQ(message->header.frame_id, "liver");
    EXPECT_EQ(message->header.stamp, stamp_);
    EXPECT_EQ(message->topology, kLastTopology + revision);
    EXPECT_EQ(message->vertices, vertices);
  }
  void expect_mesh(const OrganMeshPtr& message, std::uint32_t revision, const GridSurface& grid) {
    expect(message, revision, grid.vertices);
    EXPECT_EQ(message->triangles, grid.triangles());
  }

  const GridSurface grid_ = grid_surface(3), moved_ = grid_surface(3, 0.4);
  const GridSurface other_ = shuffled(grid_, 5);
  ros::Time stamp_{100.0};
  OrganMeshPtr mesh_;
  OrganVerticesPtr vertices_;
  OrganSource source_{{"organ", "topic", "", "points"},
                      kLastTopology,
                      {[this](const OrganMeshPtr& message) { mesh_ = message; },
                       [this](const OrganVerticesPtr& message) { vertices_ = message; }}};
};

TEST_F(OrganSourceTest, OnlyNewTrianglesAreAMeshWithTheNextTopology) {
  send(grid_);
  expect_mesh(mesh_, 1, grid_);
  send(moved_);
  expect(vertices_, 1, moved_.vertices);
  expect_mesh(source_.mesh(), 1, moved_);
  send(grid_, "table");  // Another frame is a mesh of the same topology.
  send(moved_);
  expect_mesh(mesh_, 1, moved_);
  send(other_);
  expect_mesh(mesh_, 2, other_);
  GridSurface larger = other_;  // It has a vertex that no triangle has.
  larger.vertices.insert(larger.vertices.end(), {0.1f, 0.2f, 0.3f});
  send(larger);
  expect_mesh(mesh_, 3, larger);
}

TEST_F(OrganSourceTest, AnEmptySurfaceRemovesTheOrgan) {
  send(grid_);
  send({});
  EXPECT_TRUE(mesh_->vertices.empty() && mesh_->triangles.empty());
  EXPECT_EQ(mesh_->organ, "organ");
  EXPECT_EQ(source_.mesh(), nullptr);
  expect_words(refusal([&] { send_vertices(grid_.vertices); }), {"no mesh: ", "16 vertices"});
  send(grid_);
  expect_mesh(mesh_, 2, grid_);
}

TEST_F(OrganSourceTest, VerticesNeedAMeshOfAsMany) {
  expect_words(refusal([&] { send_vertices(grid_.vertices); }),
               {"no mesh: ", "16 vertices", "'organ'"});
  send(grid_);
  for (const std::size_t count : {0, 15, 17}) {
    expect_words(refusal([&] { send_vertices(std::vector<float>(3 * count)); }),
                 {"wrong number of vertices: ", std::to_string(count) + " vertices", "has, 16"});
  }
  send_vertices(moved_.vertices);
  expect(vertices_, 1, moved_.vertices);
  expect_mesh(source_.mesh(), 1, moved_);
}

TEST_F(OrganSourceTest, WhatTheCollisionNodeRefusesIsSentButNotRemembered) {
  send(grid_);
  const ros::Time good = stamp_;
  std::vector<float> vertices = moved_.vertices;
  vertices[10] = std::nanf("");
  send_vertices(vertices);  // It is sent all the same.
  EXPECT_EQ(source_.mesh()->vertices, grid_.vertices);
  send_vertices(moved_.vertices, "table");
  EXPECT_EQ(vertices_->header.frame_id, "table");
  EXPECT_EQ(source_.mesh()->vertices, grid_.vertices);
  EXPECT_EQ(source_.mesh()->header.stamp, good);

  GridSurface broken = other_;
  broken.faces[4][1] = 16;
  send(broken);
  expect(mesh_, 2, broken.vertices);
  EXPECT_EQ(source_.mesh()->triangles, grid_.triangles());
  send(moved_);
  expect(vertices_, 1, moved_.vertices);
  broken = moved_;
  broken.vertices[0] = std::nanf("");
  send({});
  for (const GridSurface& grid : {broken, moved_}) {  // It is sent as a mesh after a refused one.
    send(grid);
    ASSERT_TRUE(mesh_);
  }
}

const std::vector<double> kPoints = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.9, 0.8};
const std::vector<float> kVertices(kPoints.begin(), kPoints.end());
const std::vector<std::uint32_t> kTriangles = {0, 1, 2};
const ros::Time kArrival(50.5);

template <typename Points>
void add_points(Points& points) {
  for (std::size_t i = 0; i < kPoints.size(); i += 3) {
    points.push_back(tf2::toMsg(Eigen::Vector3d(kPoints[i], kPoints[i + 1], kPoints[i + 2])));
  }
}

shape_msgs::Mesh shape_mesh() {
  shape_msgs::Mesh mesh;
  add_points(mesh.vertices);
  mesh.triangles.resize(1);
  mesh.triangles[0].vertex_indices = {0, 1, 2};
  return mesh;
}

pcl_msgs::PolygonMesh polygon_mesh(const std::string& frame) {
  pcl_msgs::PolygonMesh mesh;
  mesh.header.frame_id = frame;
  mesh.header.stamp = ros::Time(49.5);
  mesh.cloud = cloud_of(kPoints);
  mesh.polygons.resize(1);
  mesh.polygons[0].vertices = kTriangles;
  return mesh;
}

visualization_msgs::Marker marker() {
  visualization_msgs::Marker marker;
  marker.header.frame_id = "liver";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.scale = to_vector({1.0, 1.0, 1.0});
  add_points(marker.points);
  return marker;
}

sensor_msgs::PointCloud2 cloud(const std::string& frame) {
  sensor_msgs::PointCloud2 cloud = cloud_of(kPoints, {{{"y"}, {"x"}, {"z"}}});
  cloud.header.frame_id = frame;
  cloud.header.stamp = ros::Time(48.5);
  return cloud;
}

/// A source, with what its feed sent last.
struct Rig {
  explicit Rig(const std::string& frame = "")
      : source({"organ", "topic", frame, "points"}, 0,
               {[this](const OrganMeshPtr& message) { mesh = message; },
                [this](const OrganVerticesPtr& message) { vertices = message; }}) {}

  template <typename Message>
  void take(const Message& message, std::uint32_t cut = 0) {
    source.take_surface(shape_shifter(message, cut), kArrival);
  }
  template <typename Message>
  void take_vertices(const Message& message, std::uint32_t cut = 0) {
    source.take_vertices(shape_shifter(message, cut), kArrival);
  }

  void expect_mesh(const std::string& frame, ros::Time stamp) const {
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->header.frame_id, frame);
    EXPECT_EQ(mesh->header.stamp, stamp);
    EXPECT_EQ(mesh->vertices, kVertices);
    EXPECT_EQ(mesh->triangles, kTriangles);
  }

  OrganMeshPtr mesh;
  OrganVerticesPtr vertices;
  OrganSource source;
};

TEST(OrganSource, TakesEachType) {
  Rig shape("table"), polygons, markers;
  shape.take(shape_mesh());
  shape.expect_mesh("table", kArrival);
  polygons.take(polygon_mesh("/liver"));
  polygons.expect_mesh("liver", ros::Time(49.5));
  markers.take(marker());
  markers.expect_mesh("liver", kArrival);
  shape.take(marker());  // Another type may follow.
  ASSERT_TRUE(shape.vertices);
  EXPECT_EQ(shape.vertices->topology, shape.mesh->topology);
  shape.take(shape_msgs::Mesh());  // It removes the organ, in whatever frame.
  EXPECT_TRUE(shape.mesh->triangles.empty());
}

TEST(OrganSource, TheParameterIsTheFrameElseTheMessagesMustNameOne) {
  Rig given("liver"), rig;
  given.take(polygon_mesh("world"));
  given.expect_mesh("liver", ros::Time(49.5));
  given.take_vertices(cloud("camera"));
  EXPECT_EQ(given.vertices->header.frame_id, "liver");

  expect_words(refusal([&] { rig.take(shape_mesh()); }), {"no frame: ", "'organ'", "'frame'"});
  visualization_msgs::Marker nowhere = marker();
  nowhere.header.frame_id = "a\nb";
  expect_words(refusal([&] { rig.take(nowhere); }), {"illegal name: ", "frame 'a b'"});
  nowhere.header.frame_id = "";
  nowhere.id = 7;
  expect_words(refusal([&] { rig.take(nowhere); }), {"no frame: "});
  rig.take(marker());  // The refused marker is not the organ's.
  rig.expect_mesh("liver", kArrival);
  expect_words(refusal([&] { rig.take_vertices(cloud("")); }), {"no frame: "});
  EXPECT_FALSE(rig.vertices);
}

TEST(OrganSource, TakesVertices) {
  Rig rig;
  expect_words(refusal([&] { rig.take_vertices(cloud("liver")); }), {"no mesh: "});
  rig.take(marker());
  rig.take_vertices(cloud("/liver"));
  ASSERT_TRUE(rig.vertices);
  EXPECT_EQ(rig.vertices->header.frame_id, "liver");
  EXPECT_EQ(rig.vertices->header.stamp, ros::Time(48.5));
  EXPECT_EQ(rig.vertices->vertices, kVertices);
  EXPECT_EQ(rig.source.mesh()->header.stamp, ros::Time(48.5));
}

TEST(OrganSource, RefusesOtherTypesAndWhatIsNotAsItsTypeSays) {
  Rig rig("liver");
  expect_words(refusal([&] { rig.take(cloud("liver")); }),
               {"wrong type: ", "sensor_msgs/PointCloud2", "shape_msgs/Mesh",
                "pcl_msgs/PolygonMesh", "visualization_msgs/Marker"});
  expect_words(refusal([&] { rig.take_vertices(shape_mesh()); }),
               {"wrong type: ", "shape_msgs/Mesh", "sensor_msgs/PointCloud2"});
  expect_words(refusal([&] { rig.take(shape_mesh(), 1); }),
               {"unreadable message: ", "shape_msgs/Mesh"});
  expect_words(refusal([&] { rig.take_vertices(cloud("liver"), 3); }), {"unreadable message: "});

  ShapeShifter older = shape_shifter(shape_mesh());
  older.morph("0123456789abcdef0123456789abcdef", "shape_msgs/Mesh", "", "0");
  expect_words(refusal([&] { rig.source.take_surface(older, kArrival); }),
               {"unreadable message: ", "md5sum"});
  EXPECT_FALSE(rig.mesh);
}

}  // namespace

}  // namespace organ_collision
