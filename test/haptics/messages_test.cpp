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
