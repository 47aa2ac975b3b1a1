#include "haptics/proxy_forces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kStiffness = 170.0;
const Vector3d kPlace(0.2, 0.3, 0.5);  // the barycentric coordinates of all contacts

class ProxyForcesTest : public testing::Test {
 protected:
  Vector3d random_vector(double size) {
    std::uniform_real_distribution<double> in(-size, size);
    return {in(random_), in(random_), in(random_)};
  }

  ProxyFace contact(std::size_t organ, double load, const Vector3d& normal) {
    ProxyFace at;
    at.organ = organ;
    at.load = load;
    at.contact.face = 0;
    at.contact.vertices = {0, 1, 2};
    at.contact.barycentric = kPlace;
    at.contact.normal = normal;
    return at;
  }
  /// The place of all contacts and crossings with an organ, in the proxy's frame.
  Vector3d place(std::size_t organ) const {
    return organs_[organ].T_organ_proxy.inverse() * Vector3d(kPlace[1], kPlace[2], 0.0);
  }

  std::vector<OrganForce> forces(ProxyFreedom freedom, const Vector3d& damping = Vector3d::Zero()) {
    return proxy_forces(answer_, organs_, freedom, kStiffness, damping);
  }

  /// The force at the faces of an organ, and its torque about the tool's centre, in the proxy's
  /// frame.
  OrganForce sum_on_faces(const OrganForce& of_organ, std::size_t organ) const {
    const Eigen::Isometry3d T_proxy_organ = organs_[organ].T_organ_proxy.inverse();
    OrganForce sum;
    for (const FaceForce& at : of_organ.on_faces) {
      const Vector3d force = T_proxy_organ.linear() * at.force;
      sum.force += force;
      sum.torque += (T_proxy_organ * at.place - answer_.center).cross(force);
    }
    return sum;
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

TEST_F(ProxyForcesTest, OnAFreeToolTheyAreTheSumsOverTheFaces) {
  for (int trial = 0; trial < 100; ++trial) {
    answer_.contacts = {contact(0, 0.003, random_vector(1.0).normalized()),
                        contact(1, 0.001, random_vector(1.0).normalized()),
                        contact(1, 0.0, Vector3d::UnitX())};
    answer_.center = random_vector(0.2);
    answer_.pull = random_vector(trial % 2 == 0 ? 1e-5 : 0.01);
    const std::vector<OrganForce> found = forces(ProxyFreedom::kFree);
    ASSERT_EQ(found.size(), 2U);
    Vector3d normal_forces = Vector3d::Zero(), about_proxy = Vector3d::Zero();
    for (const ProxyFace& at : answer_.contacts) {
      const Vector3d force = -kStiffness * at.load * at.contact.normal;
      normal_forces += force;
      about_proxy += (place(at.organ) - answer_.center - answer_.pull).cross(force);
    }
    for (std::size_t organ = 0; organ < 2; ++organ) {
      const OrganForce on_faces = sum_on_faces(found[organ], organ);
      expect_near(on_faces.force, found[organ].force);
      expect_near(on_faces.torque, found[organ].torque);
    }
    expect_near(torque_of(found), about_proxy);
    if (trial % 2 == 1) continue;
    EXPECT_LT((force_of(found) - normal_forces).norm(), 1e-4);
  }
}

TEST_F(ProxyForcesTest, ThroughATrocarTheForceActsAtTheTipWithTheLeverOfItsPlace) {
  for (const double shaft : {0.25, 0.7, 1.0}) {
    for (const std::size_t organ : {0U, 1U}) {
      const Vector3d along = random_vector(0.3);
      const Vector3d normal = along.cross(Vector3d::UnitX()).normalized();
      const Vector3d trocar = place(organ) - 0.003 * normal - shaft * along;
      answer_.proxy.axis = {trocar, trocar + along};
      answer_.contacts = {contact(organ, 0.004, normal)};
      const std::vector<OrganForce> found = forces(ProxyFreedom::kTrocar);
      const Vector3d on_tissue = kStiffness * 0.004 * normal;
      expect_near(found[organ].force, -shaft * on_tissue);
      EXPECT_TRUE(found[organ].torque.isZero(0.0));
      EXPECT_TRUE(found[1 - organ].is_zero());
      ASSERT_EQ(found[organ].on_faces.size(), 1U);
      const Eigen::Isometry3d& T_organ_proxy = organs_[organ].T_organ_proxy;
      expect_near(found[organ].on_faces[0].force, -(T_organ_proxy.linear() * on_tissue));
      expect_near(found[organ].on_faces[0].place, T_organ_proxy * place(organ));
    }
  }
}

TEST_F(ProxyForcesTest, ACrossingLoadsTheTissueWholeAndTheHandWithItsLever) {
  ProxyCrossing crossing;
  crossing.organ = 1;
  crossing.face = 0;
  crossing.barycentric = kPlace;
  crossing.shaft = 0.4;
  crossing.point = place(1);
  const Vector3d way = random_vector(0.3), trocar = crossing.point - crossing.shaft * way;
  answer_.proxy.axis = {trocar, trocar + way};
  const Vector3d lengthwise = 0.02 * way.normalized();
  const Vector3d across = 0.03 * way.cross(Vector3d::UnitX()).normalized();
  crossing.load = -(lengthwise + across / crossing.shaft);
  answer_.crossings = {crossing};
  answer_.pull = lengthwise + across;
  const std::vector<OrganForce> found = forces(ProxyFreedom::kTrocar);
  expect_near(found[1].force, kStiffness * answer_.pull);
  EXPECT_TRUE(found[0].is_zero());
  ASSERT_EQ(found[1].on_faces.size(), 1U);
  const FaceForce& at = found[1].on_faces[0];
  expect_near(at.force, organs_[1].T_organ_proxy.linear() * (-kStiffness * crossing.load));
  expect_near(at.place, organs_[1].T_organ_proxy * crossing.point);
  EXPECT_EQ(at.vertices[2], 2U);
}

TEST_F(ProxyForcesTest, DampingChangesAllForcesByOneFactorAndReversesNone) {
  answer_.contacts = {contact(0, 0.01, Vector3d::UnitX()), contact(1, 0.01, Vector3d::UnitY())};
  const std::vector<OrganForce> without = forces(ProxyFreedom::kFree);
  const Vector3d whole = force_of(without);
  for (const double share : {-3.0, -1.0, -0.4, 0.0, 0.7, 1.0, 5.0}) {
    const Vector3d damping = share * whole + whole.cross(Vector3d::UnitZ());
    const std::vector<OrganForce> found = forces(ProxyFreedom::kFree, damping);
    const double factor = 1.0 + std::clamp(share, -1.0, 1.0);
    for (std::size_t organ = 0; organ < 2; ++organ) {
      expect_near(found[organ].force, factor * without[organ].force);
      expect_near(found[organ].torque, factor * without[organ].torque);
      expect_near(sum_on_faces(found[organ], organ).force, found[organ].force);
    }
  }
}
