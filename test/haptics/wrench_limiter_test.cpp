#include "haptics/wrench_limiter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;
using std::chrono::microseconds;

const Vector3d kUp = Vector3d::UnitZ();

/// The force and the torque of an organ, and half of the force on each of two faces.
OrganForce organ_force(const std::string& organ, const Vector3d& force,
                       const Vector3d& torque = Vector3d::Zero()) {
  OrganForce of_organ{organ, organ + "_frame", 3, force, torque, {}};
  for (const std::uint32_t face : {0U, 1U}) {
    of_organ.on_faces.push_back(
        {face, kShaft, {0, 1, 2}, Vector3d::UnitX(), Vector3d::Zero(), 0.5 * force});
  }
  return of_organ;
}

Vector3d sum_of(const std::vector<FaceForce>& forces) {
  Vector3d sum = Vector3d::Zero();
  for (const FaceForce& at : forces) sum += at.force;
  return sum;
}

Vector3d sum_on_faces(const std::vector<OrganForce>& forces) {
  Vector3d sum = Vector3d::Zero();
  for (const OrganForce& of_organ : forces) sum += sum_of(of_organ.on_faces);
  return sum;
}

class WrenchLimiterTest : public testing::Test {
 protected:
  const std::vector<OrganForce>& follow(const std::vector<OrganForce>& target, int us = 1000) {
    now_ += microseconds(us);
    return limiter_.follow(target, limits_, now_);
  }
  /// The force and the torque are there, whatever the rates are.
  void reach(const std::vector<OrganForce>& target) {
    const WrenchLimits limits = limits_;
    limits_ = {limits.force, limits.torque, 1e9, 1e9};
    follow({}), follow(target), follow(target);
    ASSERT_FALSE(limiter_.is_on_its_way());
    limits_ = limits;
  }

  WrenchLimiter limiter_;
  WrenchLimits limits_{3.0, 0.1, 300.0, 10.0};
  WrenchLimiter::Time now_{std::chrono::hours(1)};
};

// Also if the target goes on changing, and if a limit is lowered again on the way. Zero: the end of
// the node.
TEST_F(WrenchLimiterTest, ALowerLimitHoldsWithin10MsWhateverTheRates) {
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    limits_ = {100.0, 5.0, random.scale(1e-6, 1e4), random.scale(1e-6, 1e4)};
    reach({organ_force("liver", random.point(50.0), random.point(2.0))});
    const double lower = trial % 4 == 0 ? 0.0 : random.scale(1e-6, 10.0);
    const double before = force_of(limiter_.forces()).norm();
    const bool has_answer = random.chance(0.5);
    for (int us = 0, step = 0; us < 30000; us += step) {
      step = random.integer(100, 2000);
      limits_.force = us < 5000 && trial % 3 == 0 ? 2.0 * lower : lower;
      limits_.torque = 0.1 * limits_.force;
      std::vector<OrganForce> target;
      if (has_answer) target = {organ_force("liver", random.point(50.0), random.point(2.0))};
      const double was = force_of(limiter_.forces()).norm();
      follow(target, us == 0 ? 500000 : step);
      const double now = force_of(limiter_.forces()).norm();
      EXPECT_LE(was - now, limits_.force_rate * 2e-3 + before * 0.002 / 0.008 + 1e-9) << "no leap";
      const int since = trial % 3 == 0 ? 18000 : 10000;
      if (us < since) continue;
      EXPECT_LE(now, lower * (1.0 + 1e-12));
      EXPECT_LE(torque_of(limiter_.forces()).norm(), 0.1 * lower * (1.0 + 1e-12));
    }
    EXPECT_FALSE(lower == 0.0 && !has_answer && limiter_.is_on_its_way());
  }
}

TEST_F(WrenchLimiterTest, FacesBearTheForceInTheDirectionOfTheTarget) {
  reach({organ_force("liver", 2.0 * kUp)});
  std::vector<OrganForce> forces = follow({organ_force("liver", 0.5 * kUp)});
  EXPECT_NEAR(forces[0].force.z(), 1.7, 1e-12);
  EXPECT_LT((sum_on_faces(forces) - forces[0].force).norm(), 1e-12) << "also while it falls";
  forces = follow({organ_force("liver", 0.5 * Vector3d::UnitX())});
  EXPECT_NEAR(force_of(forces).norm(), 1.4, 0.02);
  EXPECT_LT((sum_on_faces(forces) - forces[0].force.x() * Vector3d::UnitX()).norm(), 1e-12);
  forces = follow({organ_force("liver", -0.5 * kUp)});
  EXPECT_TRUE(sum_on_faces(forces).isZero(0.0)) << "tissue only pushes";
  // Faces that press against each other.
  std::vector<OrganForce> squeezing = {organ_force("liver", 0.01 * kUp)};
  for (const double force : {100.0, -100.0}) {
    squeezing[0].on_faces.push_back(squeezing[0].on_faces[0]);
    squeezing[0].on_faces.back().force = force * kUp;
  }
  reach({organ_force("liver", 2.0 * kUp)});
  for (const FaceForce& at : follow(squeezing)[0].on_faces) EXPECT_LE(at.force.norm(), 100.0);
}

TEST_F(WrenchLimiterTest, AnOrganThatIsGoneLetsGoAndIsToldOfOnceWithoutAForce) {
  reach({organ_force("kidney", kUp), organ_force("liver", kUp)});
  int ticks = 0;
  while (follow({organ_force("kidney", kUp)}).size() == 2U) {
    const OrganForce& gone = limiter_.forces()[1];
    EXPECT_EQ(gone.organ, "liver");
    EXPECT_EQ(gone.frame, "liver_frame");
    EXPECT_EQ(gone.topology, 3U);
    EXPECT_TRUE(gone.on_faces.empty());
    EXPECT_NEAR(gone.force.z(), std::max(0.0, 1.0 - 0.3 * ++ticks), 1e-12);
  }
  EXPECT_EQ(ticks, 4);
  EXPECT_FALSE(limiter_.is_on_its_way());
}

TEST_F(WrenchLimiterTest, ForcesTurnWithTheirFrameAndAChangeOfSettingsIsExpected) {
  limiter_.expect_change();
  EXPECT_FALSE(limiter_.is_on_its_way()) << "there is no force";
  reach({organ_force("liver", kUp, {0.01, 0.0, 0.0})});
  limiter_.expect_change();
  EXPECT_TRUE(limiter_.is_on_its_way());
  limiter_.rotate(Eigen::AngleAxisd(M_PI_2, Vector3d::UnitX()).toRotationMatrix());
  EXPECT_LT((force_of(limiter_.forces()) - Vector3d(0.0, -1.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((torque_of(limiter_.forces()) - Vector3d(0.01, 0.0, 0.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace organ_collision
