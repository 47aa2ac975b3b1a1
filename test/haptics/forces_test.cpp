#include "haptics/forces.hpp"

#include <gtest/gtest.h>
#include <ros/names.h>

#include <algorithm>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "test/proof/trials.hpp"
#include "test/refusals.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// What the forces are about.
ContactArray about() {
  ContactArray contacts;
  contacts.header.frame_id = "liver";
  contacts.header.stamp = ros::Time(3, 7);
  contacts.organ = "liver";
  contacts.tool = "hook";
  contacts.topology = 4;
  return contacts;
}

TEST(VertexForces, AForceIsDividedByTheBarycentricCoordinates) {
  std::vector<FaceForce> forces(3);
  forces[0].vertices = {7, 3, 900000};
  forces[0].barycentric = {0.5, 0.25, 0.25};
  forces[0].force = {0.0, 4.0, 8.0};
  forces[1].vertices = {3, 2, 5};
  forces[1].barycentric = {0.75, 0.25, 0.0};
  forces[1].force = {1.0, 0.0, 0.0};
  const VertexForces found = vertex_forces(about(), forces);  // The third force is zero.
  EXPECT_EQ(found.header, about().header);
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

TEST(VertexForces, AreMinusTheForcesAndTheirTorques) {
  oracle::Random random(5);
  std::vector<Vector3d> cloud;
  for (int k = 0; k < 40; ++k) cloud.push_back(random.point(0.2));
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<FaceForce> forces(static_cast<std::size_t>(random.integer(0, 30)));
    for (FaceForce& at : forces) {
      const double a = random.uniform(0.0, 1.0), b = random.uniform(0.0, 1.0 - a);
      const auto first = static_cast<std::uint32_t>(random.integer(0, 37));
      at.vertices = {first + 2, first, first + 1};
      at.barycentric = {a, b, 1.0 - a - b};
      at.place = a * cloud[first + 2] + b * cloud[first] + (1.0 - a - b) * cloud[first + 1];
      at.force = random.point(1.0);
    }
    const VertexForces found = vertex_forces(about(), forces);
    Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
    for (const FaceForce& at : forces) {
      force += at.force;
      torque += at.place.cross(at.force);
    }
    EXPECT_TRUE(std::is_sorted(found.vertices.begin(), found.vertices.end()));
    for (std::size_t i = 0; i < found.vertices.size(); ++i) {
      force += to_eigen(found.forces.at(i));
      torque += cloud[found.vertices[i]].cross(to_eigen(found.forces[i]));
    }
    EXPECT_LE(force.norm(), 1e-9);
    EXPECT_LE(torque.norm(), 1e-9);
  }
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
