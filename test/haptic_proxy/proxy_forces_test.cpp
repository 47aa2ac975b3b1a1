#include "haptic_proxy/proxy_forces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <random>

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kStiffness = 170.0;

class ProxyForcesTest : public testing::Test {
 protected:
  Vector3d random_vector(double size) {
    std::uniform_real_distribution<double> in(-size, size);
    return {in(random_), in(random_), in(random_)};
  }

  ProxyFace contact(std::size_t organ, double load, double shaft) {
    ProxyFace at;
    at.organ = organ;
    at.load = load;
    at.contact.face = 0;
    at.contact.vertices = {0, 1, 2};
    at.contact.barycentric = {0.2, 0.3, 0.5};
    at.contact.point = random_vector(0.1);
    at.contact.normal = random_vector(1.0).normalized();
    at.contact.shaft = shaft;
    return at;
  }

  std::vector<OrganForce> forces(ProxyFreedom freedom, const Vector3d& damping = Vector3d::Zero()) {
    return proxy_forces(answer_, organs_, freedom, true, kStiffness, damping);
  }

  static void expect_near(const Vector3d& found, const Vector3d& expected) {
    EXPECT_LT((found - expected).norm(), 1e-12)
        << found.transpose() << ", not " << expected.transpose();
  }

  std::mt19937 random_{7};
  std::shared_ptr<const TriangleMesh> face_ = std::make_shared<TriangleMesh>(
      std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, std::vector<std::uint32_t>{0, 1, 2}, 5);
  std::vector<ProxyOrgan> organs_{
      {"liver", face_, nullptr, Eigen::Isometry3d::Identity()},
      {"kidney", face_, nullptr,
       Eigen::Translation3d(0.3, -0.1, 0.7) *
           Eigen::AngleAxisd(0.8, Vector3d(0.2, 0.9, -0.4).normalized())}};
  ProxyAnswer answer_;
};

}  // namespace

TEST_F(ProxyForcesTest, WithoutContactsAllOrgansHaveTheSameShareAndNoFaceBearsIt) {
  answer_.pull = random_vector(0.01);
  answer_.twist = random_vector(1e-4);
  answer_.center = random_vector(0.2);
  const Vector3d whole = kStiffness * answer_.pull;
  for (const OrganForce& of_organ : forces(ProxyFreedom::kFree)) {
    expect_near(of_organ.force, 0.5 * whole);
    expect_near(of_organ.torque, 0.5 * (answer_.center.cross(whole) + kStiffness * answer_.twist));
    EXPECT_TRUE(of_organ.on_faces.empty());
    EXPECT_EQ(of_organ.topology, 5U);
  }
}

TEST_F(ProxyForcesTest, OfAFreeToolTheForcesOnFacesAddUpToTheWrenches) {
  answer_.contacts = {contact(0, 0.003, 0.2), contact(1, 0.001, 0.9), contact(1, 0.0, 1.0)};
  answer_.pull = random_vector(0.01);
  answer_.twist = random_vector(1e-4);
  answer_.center = random_vector(0.2);
  const Vector3d damping = random_vector(0.5);
  const std::vector<OrganForce> found = forces(ProxyFreedom::kFree, damping);
  ASSERT_EQ(found.size(), 2U);
  Vector3d sum = Vector3d::Zero(), torque = Vector3d::Zero();
  for (std::size_t organ = 0; organ < 2; ++organ) {
    Vector3d on_faces = Vector3d::Zero();
    for (const FaceForce& at : found[organ].on_faces) on_faces += at.force;
    expect_near(on_faces, organs_[organ].T_organ_proxy.linear() * found[organ].force);
    sum += found[organ].force;
    torque += found[organ].torque;
  }
  const Vector3d whole = kStiffness * answer_.pull + damping;
  expect_near(sum, whole);
  expect_near(torque, answer_.center.cross(whole) + kStiffness * answer_.twist);
}

TEST_F(ProxyForcesTest, ThroughATrocarTheForceActsAtTheTipWithTheLeverOfTheContact) {
  answer_.contacts = {contact(0, 0.004, 0.25), contact(1, 0.002, 1.0)};
  for (const ProxyFace& at : answer_.contacts) {
    answer_.pull -= at.load * at.contact.shaft * at.contact.normal;
  }
  answer_.center = random_vector(0.2);
  const std::vector<OrganForce> found = forces(ProxyFreedom::kTrocar);
  for (std::size_t i = 0; i < 2; ++i) {
    const ProxyFace& at = answer_.contacts[i];
    const Vector3d on_tissue = kStiffness * at.load * at.contact.normal;
    expect_near(found[i].force, -at.contact.shaft * on_tissue);
    expect_near(found[i].torque, answer_.center.cross(found[i].force));
    ASSERT_EQ(found[i].on_faces.size(), 1U);
    expect_near(found[i].on_faces[0].force, -(organs_[i].T_organ_proxy.linear() * on_tissue));
    expect_near(found[i].on_faces[0].place, organs_[i].T_organ_proxy * at.contact.point);
  }
}

TEST_F(ProxyForcesTest, ACrossingLoadsTheTissueWholeAndTheHandWithItsLever) {
  ProxyCrossing crossing;
  crossing.organ = 1;
  crossing.face = 0;
  crossing.barycentric = {0.1, 0.6, 0.3};
  crossing.shaft = 0.4;
  answer_.proxy.axis = {random_vector(0.1), random_vector(0.1)};
  const Vector3d way = answer_.proxy.axis.tip - answer_.proxy.axis.trocar;
  crossing.point = answer_.proxy.axis.trocar + crossing.shaft * way;
  const Vector3d lengthwise = 0.02 * way.normalized();
  const Vector3d across = 0.03 * way.cross(Vector3d::UnitX()).normalized();
  crossing.load = -(lengthwise + across / crossing.shaft);
  answer_.crossings = {crossing};
  answer_.pull = lengthwise + across;
  const std::vector<OrganForce> found = forces(ProxyFreedom::kTrocar);
  expect_near(found[1].force, kStiffness * answer_.pull);
  EXPECT_TRUE(found[0].force.isZero(0.0));
  ASSERT_EQ(found[1].on_faces.size(), 1U);
  const FaceForce& at = found[1].on_faces[0];
  expect_near(at.force, organs_[1].T_organ_proxy.linear() * (-kStiffness * crossing.load));
  expect_near(at.place, organs_[1].T_organ_proxy * crossing.point);
  EXPECT_EQ(at.vertices[2], 2U);
  EXPECT_EQ(at.barycentric[1], 0.6);
}

TEST_F(ProxyForcesTest, OnTheirWayAddUpOnEachFaceAndDoNotGrowInNumber) {
  ForceRateLimit limit;
  const auto start = ForceRateLimit::Time();
  for (int tick = 0; tick < 300; ++tick) {
    answer_.contacts = {contact(0, 0.02, 1.0)};
    answer_.pull = -0.02 * answer_.contacts[0].contact.normal;
    const auto found = limit.follow(forces(ProxyFreedom::kFree), 10.0, Vector3d::Zero(), 0.0,
                                    start + std::chrono::milliseconds(tick));
    ASSERT_LE(found[0].on_faces.size(), 1U);
    Vector3d on_faces = Vector3d::Zero();
    for (const FaceForce& at : found[0].on_faces) on_faces += at.force;
    EXPECT_LT((on_faces - found[0].force).norm(), 1e-9);
  }
  EXPECT_TRUE(limit.is_on_its_way());
}
