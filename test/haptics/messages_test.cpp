// The parts of the messages of haptic_proxy: forces on vertices, places, and the names of topics.
#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>
#include <ros/names.h>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "haptics/places.hpp"
#include "haptics/proxy_publisher.hpp"
#include "haptics/topic_names.hpp"
#include "test/refusals.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

TEST(VertexForces, AForceIsDividedByTheBarycentricCoordinates) {
  ToolParameters tool;
  tool.name = "hook";
  const ProxyReport report{tool, "world", ros::Time(3, 7), ContactArray::OK, ""};
  OrganForce forces{"liver", "liver_frame", 4};
  forces.mesh_stamp = ros::Time(2, 9);
  forces.on_faces = {
      {0, kShaft, {7, 3, 900000}, {0.5, 0.25, 0.25}, Vector3d::Zero(), {0.0, 4.0, 8.0}},
      {1, kShaft, {3, 2, 5}, {0.75, 0.25, 0.0}, Vector3d::Zero(), {1.0, 0.0, 0.0}},
      {2, kShaft, {11, 12, 13}, {0.5, 0.25, 0.25}, Vector3d::Zero(), {0.0, 0.0, 0.0}}};
  const VertexForces found = vertex_forces_of(report, forces);
  EXPECT_EQ(found.header.stamp, report.stamp);
  EXPECT_EQ(found.header.frame_id, "liver_frame");
  EXPECT_EQ(found.mesh_stamp, forces.mesh_stamp);
  EXPECT_EQ(found.organ, "liver");
  EXPECT_EQ(found.tool, "hook");
  EXPECT_EQ(found.topology, 4u);
  EXPECT_EQ(found.vertices, (std::vector<std::uint32_t>{2, 3, 7, 900000}));
  ASSERT_EQ(found.forces.size(), 4u);
  EXPECT_EQ(to_eigen(found.forces[0]), Vector3d(-0.25, 0.0, 0.0));
  EXPECT_EQ(to_eigen(found.forces[1]), Vector3d(-0.75, -1.0, -2.0));
  EXPECT_EQ(to_eigen(found.forces[2]), Vector3d(0.0, -2.0, -4.0));
  EXPECT_EQ(to_eigen(found.forces[3]), Vector3d(0.0, -1.0, -2.0));
}

ProxyFace face_at(double distance, const std::array<std::uint32_t, 3>& vertices,
                  const Vector3d& barycentric) {
  ProxyFace at;
  at.contact.vertices = vertices;
  at.contact.barycentric = barycentric;
  at.contact.depth = -distance;
  return at;
}

TEST(Basins, APathLeadsOverSharedEdgesAndVerticesToTheNearestFace) {
  const Vector3d inside(0.2, 0.3, 0.5), on_edge(0.4, 0.6, 0.0), on_vertex(0.0, 1.0, 0.0);
  std::vector<ProxyFace> contacts = {
      face_at(3e-5, {4, 5, 6}, on_vertex),  // vertex 5, which both of the next faces have
      face_at(2e-5, {8, 5, 7}, on_edge),    // the edge from 8 to 5
      face_at(1e-5, {5, 8, 9}, inside),     // the nearest one
      face_at(2.5e-5, {7, 10, 5}, inside),  // shares vertex 5, but contains no point of the others
      face_at(4e-5, {8, 9, 11}, on_vertex)};  // vertex 9
  EXPECT_EQ(basins_of(contacts), (std::vector<std::size_t>{2, 2, 2, 3, 2}));
  contacts[2].contact.link = 0;
  EXPECT_EQ(basins_of(contacts), (std::vector<std::size_t>{1, 1, 2, 3, 4})) << "of another link";
  contacts[2].contact.link = kShaft;
  contacts[2].organ = 1;
  EXPECT_EQ(basins_of(contacts), (std::vector<std::size_t>{1, 1, 2, 3, 4})) << "of another organ";
  EXPECT_TRUE(basins_of({}).empty());
}

TEST(PairNames, AreLegalNamesOfTheGraph) {
  PairNames names;
  EXPECT_EQ(names.of("Liver_2", "hook"), "Liver_2/hook");
  EXPECT_EQ(names.of("Liver_2", "hook"), "Liver_2/hook");
  EXPECT_EQ(names.of("left lobe", "robot1/hook"), "left_lobe/robot1_hook");
  EXPECT_EQ(names.of("2", "_x"), "organ_2/tool__x");
  EXPECT_EQ(names.of("", "~"), "organ_/tool__");
  for (const char* name : {"9-7", "f\xC3\xB6ie", " ", "a\nb", "..", "://"}) {
    std::string error;
    EXPECT_TRUE(ros::names::validate(names.of(name, name), error)) << error;
  }
}

TEST(PairNames, TwoThatWouldShareTopicsAreRefused) {
  PairNames names;
  names.of("left lobe", "hook");
  expect_words(refusal_by<Rejection>([&] { names.of("left_lobe", "hook"); }),
               {"left_lobe/hook belong to organ 'left lobe'"});
  EXPECT_EQ(names.of("left lobe", "hook"), "left_lobe/hook");
  EXPECT_EQ(names.of("left_lobe", "grasper"), "left_lobe/grasper");
}

}  // namespace
}  // namespace organ_collision
