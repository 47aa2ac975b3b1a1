#include "adapters/organ_source.hpp"

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>

#include "common/messages/conversions.hpp"
#include "surface_messages.hpp"
#include "test/closed_surfaces.hpp"

namespace organ_collision {
namespace {

using topic_tools::ShapeShifter;
using visualization_msgs::Marker;

constexpr std::uint32_t kLastTopology = 4294967294;  // The second mesh's wraps to 0.
const ros::Time kArrival(50.5);

std::vector<geometry_msgs::Point> points_of(const std::vector<float>& vertices) {
  std::vector<geometry_msgs::Point> points;
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    points.push_back(tf2::toMsg(Eigen::Vector3d(vertices[i], vertices[i + 1], vertices[i + 2])));
  }
  return points;
}

shape_msgs::Mesh shape_mesh(const GridSurface& surface) {
  shape_msgs::Mesh mesh;
  mesh.vertices = points_of(surface.vertices);
  for (const FaceIndices& face : surface.faces) {
    mesh.triangles.emplace_back();
    mesh.triangles.back().vertex_indices = {face[0], face[1], face[2]};
  }
  return mesh;
}

/// `soup`: each face has vertices of its own.
Marker marker(const GridSurface& soup, const std::string& frame) {
  Marker marker;
  marker.header.frame_id = frame;
  marker.type = Marker::TRIANGLE_LIST;
  marker.scale = to_vector({1.0, 1.0, 1.0});
  marker.points = points_of(soup.vertices);
  return marker;
}

/// The message as a subscriber receives it, without its last `cut` bytes.
template <typename Message>
ShapeShifter received(const Message& message, std::uint32_t cut = 0) {
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

/// Keeps what the source sent in the last call: `mesh_` or `vertices_`. The other one is null.
class OrganSourceTest : public testing::Test {
 protected:
  template <typename Message>
  void take(const Message& message, std::uint32_t cut = 0) {
    mesh_.reset();
    vertices_.reset();
    source_.take_surface(received(message, cut), kArrival);
    ASSERT_NE(mesh_ == nullptr, vertices_ == nullptr);
  }
  template <typename Message>
  void take_vertices(const Message& message, std::uint32_t cut = 0) {
    mesh_.reset();
    vertices_.reset();
    source_.take_vertices(received(message, cut), kArrival);
    ASSERT_TRUE(vertices_);
  }
  /// A message has a later stamp than the last one.
  sensor_msgs::PointCloud2 cloud(const std::vector<float>& vertices, const std::string& frame) {
    sensor_msgs::PointCloud2 cloud = cloud_of({vertices.begin(), vertices.end()});
    cloud.header.frame_id = frame;
    cloud.header.stamp = stamp_ += ros::Duration(0.01);
    return cloud;
  }
  pcl_msgs::PolygonMesh polygons(const GridSurface& surface, const std::string& frame) {
    pcl_msgs::PolygonMesh mesh;
    mesh.cloud = cloud(surface.vertices, frame);
    for (const FaceIndices& face : surface.faces) {
      mesh.polygons.emplace_back();
      mesh.polygons.back().vertices.assign(face.begin(), face.end());
    }
    return mesh;
  }
  void send(const GridSurface& surface) { take(polygons(surface, "liver")); }
  void send_vertices(const std::vector<float>& vertices) {
    take_vertices(cloud(vertices, "liver"));
  }

  /// `revision`: of the topology.
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
  /// A source for which the parameters `frame` and `scale` are given.
  OrganSource source(const std::string& frame, double scale = 1.0) {
    return {{"organ", "topic", frame, "points", scale},
            kLastTopology,
            {[this](const OrganMeshPtr& message) {
               removals_ += message->vertices.empty() ? 1 : 0;
               mesh_ = message;
             },
             [this](const OrganVerticesPtr& message) { vertices_ = message; }}};
  }

  const GridSurface grid_ = grid_surface(3), moved_ = grid_surface(3, 0.4);
  const GridSurface other_ = shuffled(grid_, 5);
  ros::Time stamp_{100.0};
  OrganMeshPtr mesh_;
  OrganVerticesPtr vertices_;
  int removals_ = 0;  ///< since the start
  OrganSource source_ = source("");
};

TEST_F(OrganSourceTest, OnlyNewTrianglesAreAMeshWithTheNextTopology) {
  send(grid_);
  expect_mesh(mesh_, 1, grid_);
  send(moved_);
  expect(vertices_, 1, moved_.vertices);
  expect_mesh(source_.mesh(), 1, moved_);
  take(polygons(grid_, "table"));  // Another frame is a mesh of the same topology.
  send(moved_);
  expect_mesh(mesh_, 1, moved_);
  send(other_);
  expect_mesh(mesh_, 2, other_);
  GridSurface larger = other_;  // It has a vertex that no triangle has.
  larger.vertices.insert(larger.vertices.end(), {0.1f, 0.2f, 0.3f});
  send(larger);
  expect_mesh(mesh_, 3, larger);
  send({});  // It removes the organ.
  EXPECT_TRUE(mesh_->vertices.empty() && mesh_->triangles.empty());
  EXPECT_EQ(mesh_->organ, "organ");
  EXPECT_EQ(source_.mesh(), nullptr);
  send(larger);
  expect_mesh(mesh_, 4, larger);
}

TEST_F(OrganSourceTest, TheFirstShapeOfARestartedSenderReplacesTheOrgan) {
  source_.restart();
  send(grid_);
  expect_mesh(mesh_, 1, grid_);
  EXPECT_EQ(removals_, 0) << "there was nothing before";
  source_.restart();
  send(moved_);
  expect_mesh(mesh_, 2, moved_);
  EXPECT_EQ(removals_, 1);
  send(grid_);
  expect(vertices_, 2, grid_.vertices);
  source_.restart();
  mesh_.reset();
  source_.take_vertices(received(cloud(moved_.vertices, "liver")), kArrival);
  expect_mesh(mesh_, 3, moved_);
  EXPECT_EQ(removals_, 2);
  send_vertices(grid_.vertices);
  expect(vertices_, 3, grid_.vertices);
  source_.restart();
  send({});
  send(grid_);
  EXPECT_EQ(removals_, 3) << "it is removed once";
}

TEST_F(OrganSourceTest, VerticesNeedAMeshOfAsMany) {
  const auto refusal_of = [this](std::size_t count) {
    return refusal([&] { send_vertices(std::vector<float>(3 * count)); });
  };
  expect_words(refusal_of(16), {"no mesh: ", "16 vertices", "'organ'"});
  send(grid_);
  for (const std::size_t count : {0, 15, 17}) {
    expect_words(refusal_of(count),
                 {"wrong number of vertices: ", std::to_string(count) + " vertices", "has, 16"});
  }
  send_vertices(moved_.vertices);
  expect(vertices_, 1, moved_.vertices);
  expect_mesh(source_.mesh(), 1, moved_);
  send({});
  expect_words(refusal_of(16), {"no mesh: "});
}

TEST_F(OrganSourceTest, WhatTheCollisionNodeRefusesIsSentButNotRemembered) {
  send(grid_);
  const ros::Time good = stamp_;
  GridSurface broken = moved_;
  broken.vertices[10] = 1e30f;
  send_vertices(broken.vertices);  // It is sent all the same.
  EXPECT_EQ(source_.mesh()->vertices, grid_.vertices);
  take_vertices(cloud(moved_.vertices, "table"));
  EXPECT_EQ(vertices_->header.frame_id, "table");
  EXPECT_EQ(source_.mesh()->vertices, grid_.vertices);
  EXPECT_EQ(source_.mesh()->header.stamp, good);

  GridSurface out_of_range = other_;
  out_of_range.faces[4][1] = 16;
  send(out_of_range);
  expect(mesh_, 2, out_of_range.vertices);
  EXPECT_EQ(source_.mesh()->triangles, grid_.triangles());
  send(moved_);
  expect(vertices_, 1, moved_.vertices);
  send({});
  for (const GridSurface& grid : {broken, moved_}) {  // It is sent as a mesh after a refused one.
    send(grid);
    ASSERT_TRUE(mesh_);
  }
}

TEST_F(OrganSourceTest, TakesEachTypeAndTheMessagesFrameUnlessTheParameterNamesOne) {
  const GridSurface soup = unwelded(grid_);
  take(polygons(grid_, "/liver"));
  expect_mesh(mesh_, 1, grid_);
  take(marker(soup, "liver"));  // Another type may follow.
  stamp_ = kArrival;            // It has no stamp.
  expect_mesh(mesh_, 2, soup);
  expect_words(refusal([&] { take(shape_mesh(grid_)); }), {"no frame: ", "'organ'", "'frame'"});
  expect_words(refusal([&] { take_vertices(cloud(soup.vertices, "")); }), {"no frame: "});
  expect_words(refusal([&] { take(marker(soup, "a\nb")); }), {"illegal name: ", "frame 'a b'"});

  source_ = source("liver");
  Marker refused = marker(soup, "a\nb");
  refused.id = 7;
  expect_words(refusal([&] { take(refused); }), {"illegal name: "});
  take(marker(soup, "world"));  // The refused marker is not the organ's.
  stamp_ = kArrival;
  expect_mesh(mesh_, 1, soup);
  take(shape_mesh(grid_));
  expect_mesh(mesh_, 2, grid_);
  take_vertices(cloud(moved_.vertices, "camera"));
  expect(vertices_, 2, moved_.vertices);
  take(shape_msgs::Mesh());
  EXPECT_TRUE(mesh_->triangles.empty());
}

TEST_F(OrganSourceTest, TheSendersUnitBecomesMetresInAllMessages) {
  const auto in_quarters = [](GridSurface grid) {
    for (float& coordinate : grid.vertices) coordinate *= 4.0f;
    return grid;
  };
  source_ = source("liver", 0.25);
  send(in_quarters(grid_));
  expect_mesh(mesh_, 1, grid_);
  send_vertices(in_quarters(moved_).vertices);
  expect(vertices_, 1, moved_.vertices);
  expect_mesh(source_.mesh(), 1, moved_);
  const GridSurface soup = unwelded(grid_);
  take(marker(in_quarters(soup), "liver"));
  stamp_ = kArrival;
  expect_mesh(mesh_, 2, soup);

  source_ = source("liver", 1e30);
  send(GridSurface());
  GridSurface huge = grid_;
  huge.vertices[5] = 1e10f;
  expect_words(refusal([&] { send(huge); }), {"not finite: ", "z of vertex 1 is 1e+40"});
}

TEST_F(OrganSourceTest, RefusesOtherTypesAndWhatIsNotAsItsTypeSays) {
  const sensor_msgs::PointCloud2 points = cloud(grid_.vertices, "liver");
  const shape_msgs::Mesh mesh = shape_mesh(grid_);
  expect_words(refusal([&] { take(points); }),
               {"wrong type: ", "sensor_msgs/PointCloud2", "shape_msgs/Mesh",
                "pcl_msgs/PolygonMesh", "visualization_msgs/Marker"});
  expect_words(refusal([&] { take_vertices(mesh); }),
               {"wrong type: ", "shape_msgs/Mesh", "sensor_msgs/PointCloud2"});
  expect_words(refusal([&] { take(mesh, 1); }), {"unreadable message: ", "shape_msgs/Mesh"});
  expect_words(refusal([&] { take_vertices(points, 3); }), {"unreadable message: "});
  ShapeShifter older = received(mesh);
  older.morph("0123456789abcdef0123456789abcdef", "shape_msgs/Mesh", "", "0");
  expect_words(refusal([&] { source_.take_surface(older, kArrival); }),
               {"unreadable message: ", "md5sum"});
}

}  // namespace
}  // namespace organ_collision
