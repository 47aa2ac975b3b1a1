#include "forces/forces.hpp"

#include <gtest/gtest.h>
#include <ros/names.h>

#include <algorithm>
#include <limits>
#include <map>

#include "contact_adapter/force_law.hpp"
#include "ros/messages/failure_log.hpp"
#include "test/contact_adapter/force_trajectory.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

TEST(ForceLimit, TheSumIsLimitedAndAllPartsAreScaledAlike) {
  std::vector<FaceForce> forces(2);  // with the sum (3, 0, -4)
  forces[0].force = {5.0, 1.0, -4.0};
  forces[1].force = {-2.0, -1.0, 0.0};
  for (const double most : {5.0, 6.0, std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(limit_force(forces, most));
    EXPECT_EQ(forces[0].force, Vector3d(5.0, 1.0, -4.0));
  }
  EXPECT_TRUE(limit_force(forces, 2.5));
  EXPECT_EQ(forces[0].force, Vector3d(2.5, 0.5, -2.0));
  EXPECT_EQ(forces[1].force, Vector3d(-1.0, -0.5, 0.0));
}

/// An answer about a tool that touches random faces of a cloud of vertices.
ContactArray random_answer(const std::vector<Vector3d>& cloud, oracle::Random& random) {
  std::map<std::uint32_t, Contact> contacts;
  const int count = random.integer(0, 30);
  for (int i = 0; i < count; ++i) {
    const double a = random.uniform(0.0, 1.0), b = random.uniform(0.0, 1.0 - a);
    Contact at = contact(Vector3d::Zero(), random.direction(), random.uniform(-0.002, 0.006));
    at.face = static_cast<std::uint32_t>(random.integer(0, 20));
    const auto first = static_cast<std::uint32_t>(random.integer(0, cloud.size() - 3));
    at.vertices = {first + 2, first, first + 1};
    at.barycentric = {a, b, 1.0 - a - b};
    if (random.chance(0.3)) at.barycentric = {a, 1.0 - a, 0.0};
    Vector3d end = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) end += at.barycentric[k] * cloud[at.vertices[k]];
    at.end_point = tf2::toMsg(end);
    contacts.insert({at.face, at});
  }
  ContactArray answer = touched({});
  for (const auto& [face, at] : contacts) answer.contacts.push_back(at);
  return answer;
}

std::vector<Vector3d> random_cloud(oracle::Random& random) {
  std::vector<Vector3d> cloud;
  for (int k = 0; k < 40; ++k) cloud.push_back(random.point(0.2));
  return cloud;
}

TEST(VertexForces, AForceIsDividedByTheBarycentricCoordinates) {
  std::vector<FaceForce> forces(3);
  forces[0].vertices = {7, 3, 900000};
  forces[0].barycentric = {0.5, 0.25, 0.25};
  forces[0].force = {0.0, 4.0, 8.0};
  forces[1].vertices = {3, 2, 5};
  forces[1].barycentric = {0.75, 0.25, 0.0};
  forces[1].force = {1.0, 0.0, 0.0};
  ContactArray contacts = touched({});  // The third force is zero.
  contacts.topology = 4;
  const VertexForces found = vertex_forces(contacts, forces);
  EXPECT_EQ(found.header, contacts.header);
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

TEST(VertexForces, CoordinatesThatAreNotBarycentricAreRefused) {
  std::vector<FaceForce> forces(1);
  forces[0].force = {0.0, 4.0, 8.0};
  EXPECT_THROW(vertex_forces(touched({}), forces), Rejection);
  forces[0].barycentric = {0.5, std::nan(""), 0.5};
  EXPECT_THROW(vertex_forces(touched({}), forces), Rejection);
  forces[0].barycentric = {0.5, 0.25, 0.25};
  EXPECT_EQ(vertex_forces(touched({}), forces).vertices.size(), 1u);
}

TEST(VertexForces, AreMinusTheWrenchForRandomContactsThatMove) {
  // The forces lag, are clipped, and lose faces. Tool and tissue move from answer to answer.
  oracle::Random random(5);
  std::vector<Vector3d> cloud;
  const auto expect_minus_wrench = [&](const std::vector<FaceForce>& forces) {
    const VertexForces found = vertex_forces(touched({}), forces);
    const geometry_msgs::Wrench wrench = wrench_of(forces);
    Vector3d force = to_eigen(wrench.force), torque = to_eigen(wrench.torque);
    EXPECT_TRUE(std::is_sorted(found.vertices.begin(), found.vertices.end()));
    for (std::size_t i = 0; i < found.vertices.size(); ++i) {
      force += to_eigen(found.forces.at(i));
      torque += cloud[found.vertices[i]].cross(to_eigen(found.forces[i]));
    }
    EXPECT_LE(force.norm(), 1e-9);
    EXPECT_LE(torque.norm(), 1e-9);
  };
  for (int i = 0; i < 40; ++i) {
    ForceLaw law;
    cloud = random_cloud(random);
    for (int step = 0; step < 50; ++step) {
      for (Vector3d& vertex : cloud) vertex += random.point(0.003);
      auto forces =
          law.follow(random_answer(cloud, random), 0.001, 1000.0, random.chance(0.9) ? 0.005 : 0.0);
      expect_minus_wrench(forces);
      limit_force(forces, 0.5);
      EXPECT_LE(sum_of(forces).norm(), 0.5 + 1e-12);
      expect_minus_wrench(forces);
    }
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
  try {
    names.of("left_lobe", "hook");
    FAIL();
  } catch (const Rejection& rejection) {
    EXPECT_EQ(rejection.reason(), "name taken");
    const std::string message = rejection.what();
    EXPECT_NE(message.find("left_lobe/hook belong to organ 'left lobe'"), std::string::npos)
        << message;
  }
  EXPECT_EQ(names.of("left lobe", "hook"), "left_lobe/hook");
  EXPECT_EQ(names.of("left_lobe", "grasper"), "left_lobe/grasper");
}

}  // namespace
}  // namespace organ_collision
