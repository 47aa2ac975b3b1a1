#include "mesh_adapter/organ_source.hpp"

#include <gtest/gtest.h>
#include <pcl_msgs/PolygonMesh.h>
#include <shape_msgs/Mesh.h>
#include <tf2_eigen/tf2_eigen.h>

#include "clouds.hpp"
#include "refusal.hpp"
#include "ros/interface/conversions.hpp"

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
}

TEST(OrganSource, AnotherTypeMayFollow) {
  Rig rig("liver");
  rig.take(shape_mesh());
  rig.take(marker());
  ASSERT_TRUE(rig.vertices);
  EXPECT_EQ(rig.vertices->topology, rig.mesh->topology);
}

TEST(OrganSource, TheParameterIsTheFrameWhateverTheMessagesSay) {
  Rig rig("liver");
  rig.take(polygon_mesh("world"));
  rig.expect_mesh("liver", ros::Time(49.5));
  rig.take_vertices(cloud("camera"));
  EXPECT_EQ(rig.vertices->header.frame_id, "liver");
}

TEST(OrganSource, RefusesMessagesWithoutFrame) {
  Rig rig;
  expect_words(refusal([&] { rig.take(shape_mesh()); }), {"no frame: ", "'organ'", "'frame'"});
  rig.take(polygon_mesh("liver"));
  expect_words(refusal([&] { rig.take_vertices(cloud("")); }), {"no frame: "});
  EXPECT_FALSE(rig.vertices);
}

TEST(OrganSource, ARefusedMarkerIsNotTheOrgans) {
  Rig rig;
  visualization_msgs::Marker nowhere = marker();
  nowhere.header.frame_id = "a\nb";
  expect_words(refusal([&] { rig.take(nowhere); }), {"illegal name: ", "frame 'a b'"});
  nowhere.header.frame_id = "";
  nowhere.id = 7;
  expect_words(refusal([&] { rig.take(nowhere); }), {"no frame: "});
  rig.take(marker());
  rig.expect_mesh("liver", kArrival);
}

TEST(OrganSource, AnOrganIsRemovedInWhateverFrame) {
  Rig rig;
  rig.take(shape_msgs::Mesh());
  ASSERT_TRUE(rig.mesh);
  EXPECT_TRUE(rig.mesh->triangles.empty());
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

TEST(OrganSource, RefusesOtherTypes) {
  Rig rig("liver");
  expect_words(refusal([&] { rig.take(cloud("liver")); }),
               {"wrong type: ", "sensor_msgs/PointCloud2", "shape_msgs/Mesh",
                "pcl_msgs/PolygonMesh", "visualization_msgs/Marker"});
  expect_words(refusal([&] { rig.take_vertices(shape_mesh()); }),
               {"wrong type: ", "shape_msgs/Mesh", "sensor_msgs/PointCloud2"});
}

TEST(OrganSource, RefusesWhatIsNotAsItsTypeSays) {
  Rig rig("liver");
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
