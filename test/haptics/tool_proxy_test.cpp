#include "haptics/tool_proxy.hpp"

#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "haptics/organ_interpolation.hpp"
#include "haptics/proxy_publisher.hpp"
#include "node/motion/transform_buffer.hpp"
#include "node/organs/organ_registry.hpp"
#include "test/node/tools/hand_made_tools.hpp"
#include "test/refusals.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

constexpr double kRadius = 0.004;
constexpr double kTolerance = 1e-5;  // [N] The loads are about a millionth too small.

/// A tool above a sheet at z = 0.
class ToolProxyTest : public testing::Test {
 protected:
  ToolProxyTest() {
    ros::Time::init();
    tool_.parameters.freedom = ProxyFreedom::kTrocar;
    parameters_.max_force = parameters_.max_torque = kUnlimited;
    // The force is there at once.
    parameters_.max_force_rate = 1e6;
    parameters_.max_torque_rate = 1e5;
  }

  /// The hand's tip is at a height [m], some milliseconds later.
  ProxyReport follow(ToolProxy& proxy, double height, double milliseconds = 20.0) {
    pass(milliseconds);
    const Vector3d tip(0.011, -0.007, height);
    return proxy.follow({{{trocar_, tip}}, stamp_}, scene_, now_);
  }
  ProxyReport lose(ToolProxy& proxy, double milliseconds) {
    pass(milliseconds);
    return proxy.lose(ContactArray::STALE_MESH, "the mesh is old", "liver_frame", now_);
  }
  void pass(double milliseconds) {
    now_ += std::chrono::duration_cast<ToolProxy::Time::duration>(
        std::chrono::duration<double, std::milli>(milliseconds));
    stamp_ += ros::Duration(1e-3 * milliseconds);
  }

  static double force(const ProxyReport& report) {
    return std::accumulate(
        report.forces.begin(), report.forces.end(), 0.0,
        [](double sum, const OrganForce& of_organ) { return sum + of_organ.force.z(); });
  }
  /// The force after the proxy stopped at its clearance from the sheet [N].
  double spring(double height) const {
    return parameters_.stiffness * (kRadius + parameters_.clearance - height);
  }
  /// The hand reaches a height, and the whole force is there.
  void press(ToolProxy& proxy, double height) {
    for (const double at : {0.03, 0.01, height, height}) follow(proxy, at);
  }

  const Vector3d trocar_{0.02, 0.01, 0.3};
  Tool tool_ = shaft_tool("hook", kRadius);
  HapticProxyParameters parameters_;
  DeformableOrgan organ_{
      "liver", "liver_frame",
      TriangleMesh({-0.3F, -0.2F, 0.0F, 0.3F, -0.2F, 0.0F, 0.0F, 0.4F, 0.0F}, {0, 1, 2}),
      ros::Time(1), ros::Time(1)};
  ProxyScene scene_{"liver_frame",
                    {{"liver", organ_.latest().mesh, nullptr, Eigen::Isometry3d::Identity()}},
                    {&organ_},
                    {},
                    {TissueMotion()}};
  ToolProxy::Time now_{std::chrono::hours(3)};
  ros::Time stamp_{50.0};
};

}  // namespace

TEST_F(ToolProxyTest, WithoutAnAnswerTheForceFadesAndComesBack) {
  ToolProxy proxy(tool_, parameters_);
  press(proxy, -0.01);
  parameters_.max_force_rate = 500.0;
  const double whole = spring(-0.01);
  EXPECT_NEAR(force(lose(proxy, 1.0)), whole - 0.5, kTolerance);
  EXPECT_TRUE(proxy.is_fading());
  const ProxyReport fading = lose(proxy, 2.0);
  EXPECT_TRUE(fading.is_fading);
  EXPECT_EQ(fading.forces[0].frame, "liver_frame");
  EXPECT_NEAR(force(fading), whole - 1.5, kTolerance);
  EXPECT_EQ(fading.status, ContactArray::STALE_MESH);
  EXPECT_EQ(fading.message, "the mesh is old");
  EXPECT_EQ(fading.answer, nullptr);
  EXPECT_TRUE(fading.forces[0].on_faces.empty()) << "the tissue is let go at once";
  EXPECT_NEAR(force(lose(proxy, 500.0)), whole - 2.5, kTolerance) << "a pause counts as 2 ms";
  for (int i = 0; i < 5; ++i) lose(proxy, 1.0);
  EXPECT_FALSE(proxy.is_fading());
  EXPECT_TRUE(lose(proxy, 1.0).forces.empty());

  EXPECT_NEAR(force(follow(proxy, -0.01, 500.0)), 1.0, kTolerance);
  EXPECT_TRUE(proxy.is_fading());
  for (int i = 0; i < 7; ++i) follow(proxy, -0.01, 1.0);
  EXPECT_NEAR(force(follow(proxy, -0.01, 1.0)), whole, kTolerance);
  EXPECT_FALSE(proxy.is_fading());
}

TEST_F(ToolProxyTest, AForceMovesWithItsFrame) {
  ToolProxy proxy(tool_, parameters_);
  press(proxy, -0.01);
  parameters_.max_force_rate = 100.0;
  const Eigen::Isometry3d T_new_old =
      Eigen::Translation3d(1.0, 2.0, 3.0) * Eigen::AngleAxisd(M_PI_2, Vector3d::UnitX());
  proxy.change_frame("world", T_new_old);
  const ProxyReport report = lose(proxy, 1.0);
  EXPECT_EQ(report.frame, "world");
  const Vector3d expected = T_new_old.linear() * Vector3d(0.0, 0.0, spring(-0.01) - 0.1);
  EXPECT_LT((force_of(report.forces) - expected).norm(), kTolerance);
  const Vector3d tip = T_new_old * Vector3d(0.011, -0.007, -0.01);
  EXPECT_LT((report.center - tip).norm(), 1e-12);
  EXPECT_LT((report.hand->axis.tip - tip).norm(), 1e-12) << "drivers move the torque to the tip";
}

// The simulator sends no shape any more.
TEST_F(ToolProxyTest, OfAToolInLockstepALowerLimitHoldsAtOnceWithoutAShape) {
  for (const bool in_lockstep : {true, false}) {
    tool_.parameters.lockstep = in_lockstep;
    ToolProxy proxy(tool_, parameters_);
    EXPECT_FALSE(proxy.lower(now_)) << "there is no answer";
    press(proxy, -0.01);
    const HapticProxyParameters before = parameters_;
    EXPECT_FALSE(proxy.lower(now_)) << "the force is within its limit";
    parameters_.max_force = 0.5;
    proxy.update_settings();
    const auto lowered = proxy.lower(now_);
    ASSERT_EQ(lowered.has_value(), in_lockstep);
    if (!lowered) continue;
    EXPECT_NEAR(force(*lowered), 0.5, kTolerance);
    EXPECT_STREQ(lowered->clipped_by, names::kMaxForce);
    EXPECT_EQ(fault_of(*lowered, 0.0, 0.0), "");
    EXPECT_FALSE(proxy.lower(now_));
    parameters_ = before;
    EXPECT_NEAR(force(follow(proxy, -0.01)), spring(-0.01), kTolerance) << "the next shape";
  }
}

TEST_F(ToolProxyTest, DampingResistsTheMotionButNeverPullsTheHandIn) {
  parameters_.damping = 2.0;
  ToolProxy proxy(tool_, parameters_);
  press(proxy, 0.0);
  const double velocity = 0.1;  // [m/s]
  const ProxyReport inward = follow(proxy, -0.001, 10.0);
  EXPECT_NEAR(force(inward), spring(-0.001) + 2.0 * velocity, 2e-3);
  EXPECT_NEAR(force(follow(proxy, -0.001, 10.0)), spring(-0.001), 2e-3);
  const ProxyReport outward = follow(proxy, 0.0, 10.0);
  EXPECT_NEAR(force(outward), spring(0.0) - 2.0 * velocity, 2e-3);
  const ProxyReport fast = follow(proxy, 0.004, 1.0);
  EXPECT_NEAR(force(fast), 0.0, 1e-9) << "2 N s/m times 4 m/s is more than the spring has";
}

TEST_F(ToolProxyTest, TheLeapOfANeedleThatPiercesIsNoVelocity) {
  parameters_.damping = 2.0;
  parameters_.puncture_force = 3.0;
  parameters_.friction = 1.0;
  ToolProxy proxy(tool_, parameters_);
  press(proxy, 0.0);
  int ticks_in_tissue = 0;
  for (double height = 0.0; ticks_in_tissue < 5; height -= 1e-4) {
    ASSERT_GT(height, -0.02);
    const ProxyReport report = follow(proxy, height, 1.0);
    if (report.answer->state != ProxyStatus::kPunctured) continue;
    EXPECT_GT(force(report), 0.9) << "the friction, and 0.1 m/s against it";
    ++ticks_in_tissue;
  }
}

TEST_F(ToolProxyTest, AnIllegalHandAndAForceThatIsNotFiniteAreRefused) {
  parameters_.damping = 2.0;
  ToolProxy proxy(tool_, parameters_);
  press(proxy, -0.01);
  EXPECT_THROW(follow(proxy, std::nan("")), std::invalid_argument);
  EXPECT_NEAR(force(follow(proxy, -0.01)), spring(-0.01), kTolerance) << "the proxy stays";
  parameters_.stiffness = 1e308;
  parameters_.jump = std::numeric_limits<double>::infinity();
  proxy.update_settings();
  EXPECT_THROW(follow(proxy, -3.0), Rejection);
}

// Dozens of faces of a fine, flat sheet are near the tip, and only one place.
TEST_F(ToolProxyTest, AStateHasTheNearestPlaceOfEachPatchWithItsForce) {
  constexpr int kCells = 40;
  constexpr float kSize = 5e-4F;  // [m]
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (int row = 0; row <= kCells; ++row) {
    for (int column = 0; column <= kCells; ++column) {
      vertices.insert(vertices.end(), {static_cast<float>(column) * kSize,
                                       static_cast<float>(row) * kSize - 0.02F, 0.0F});
      if (row == kCells || column == kCells) continue;
      const auto a = static_cast<std::uint32_t>(row * (kCells + 1) + column), b = a + kCells + 1;
      triangles.insert(triangles.end(), {a, a + 1, b, a + 1, b + 1, b});
    }
  }
  const DeformableOrgan sheet("liver", "liver_frame", TriangleMesh(vertices, triangles),
                              ros::Time(1), ros::Time(1));
  scene_.organs[0].shape = sheet.latest().mesh;
  parameters_.row_reach = 0.0;
  ToolProxy proxy(tool_, parameters_);
  press(proxy, 0.0);
  const ProxyReport report = follow(proxy, 0.0);
  const std::vector<ProxyContact> places = state_of(report).contacts;
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(places[0].organ, "liver");
  EXPECT_EQ(places[0].link, -1);
  EXPECT_NEAR(places[0].distance, parameters_.clearance, 2e-6);
  EXPECT_NEAR(places[0].normal.z, -1.0, 1e-6);
  EXPECT_NEAR(places[0].force.z, -force(report), 0.02);
  EXPECT_EQ(to_eigen(places[0].velocity), Vector3d(0.0, 0.0, 0.0));
  const double hover = kRadius + 1.5 * parameters_.clearance;
  const ProxyReport free = follow(proxy, hover);
  ASSERT_EQ(free.answer->state, ProxyStatus::kFree);
  ASSERT_EQ(state_of(free).contacts.size(), 1U) << "a free proxy tells what is near, too";
  EXPECT_NEAR(state_of(free).contacts[0].distance, 1.5 * parameters_.clearance, 2e-6);
  EXPECT_EQ(state_of(free).contacts[0].force.z, 0.0);
  EXPECT_TRUE(state_of(follow(proxy, kRadius + 3.0 * parameters_.clearance)).contacts.empty());
}

/// The proxy goes up with a clearance that rises, at its speed, and is never squeezed. It goes down
/// with one that falls, at once.
TEST_F(ToolProxyTest, AClearanceRisesAtItsSpeedAndFallsAtOnce) {
  for (const double milliseconds : {1.0, 8.0}) {
    ToolProxy proxy(tool_, parameters_);
    parameters_.clearances = {{"", "shaft", 2e-3}, {"kidney", "", 0.02}};
    press(proxy, -0.01);
    double height = follow(proxy, -0.01).proxy->axis.tip.z();
    EXPECT_NEAR(height, kRadius + 2e-3, 1e-5);
    parameters_.clearances.push_back({"liver", "shaft", 7e-3});
    proxy.update_settings();
    const double step = parameters_.clearance_speed * 1e-3 * milliseconds;
    int ticks = 0;
    for (; height < kRadius + 7e-3 - 2e-5; ++ticks) {
      const ProxyReport report = follow(proxy, -0.01, milliseconds);
      ASSERT_EQ(report.answer->state, ProxyStatus::kTouching);
      ASSERT_LT(report.proxy->axis.tip.z(), height + 1.02 * step + 1e-5);
      ASSERT_GT(report.proxy->axis.tip.z(), height);
      height = report.proxy->axis.tip.z();
      ASSERT_NEAR(state_of(report).contacts.at(0).clearance, height - kRadius, 1e-5);
    }
    EXPECT_NEAR(ticks, 5e-3 / step, 1.0);
    parameters_.clearances = {{"liver", "", 1e-3}};
    proxy.update_settings();
    EXPECT_NEAR(follow(proxy, -0.01, 1.0).proxy->axis.tip.z(), kRadius + 1e-3, 1e-5);
    parameters_.clearances = {{"liver", "shaft", 0.0}};
    EXPECT_EQ(follow(proxy, -0.01, 1.0).answer->state, ProxyStatus::kFree);
  }
}

TEST_F(ToolProxyTest, TheLagOfAFrameIsThatOfItsPoseAndNotOfAMeshThatWasSentLongAgo) {
  FaceContact contact;
  contact.normal = Vector3d(0.0, 0.0, -1.0);
  scene_.motions.resize(1);
  TissueMotion& motion = scene_.motions[0];
  ProxyOrgan guarded;
  tell_motion(scene_, 0, true, true, guarded);
  EXPECT_FALSE(guarded.advance || guarded.approach) << "the organ rests";
  motion.T_before = scene_.organs[0].T_organ_proxy * Eigen::Translation3d(0.0, 0.0, 1e-4);
  motion.frame_lag_sec = 0.02;
  tell_motion(scene_, 0, true, true, guarded);
  ASSERT_TRUE(guarded.advance && guarded.approach);
  const double speed = tissue_velocity(scene_, 0, contact).z();
  EXPECT_GT(speed, 1e-4);
  EXPECT_NEAR(guarded.advance(contact), 0.02 * speed, 1e-12);
  EXPECT_NEAR(guarded.approach(contact), speed, 1e-12);
  EXPECT_NEAR(guarded.most_advance, 0.02 * speed, 1e-12);
  EXPECT_NEAR(guarded.most_approach, speed, 1e-12);
}

/// Tissue rises by 31 mm/s from 10 mm below a hand, in shapes at 60 Hz.
class RisingTissueTest : public ToolProxyTest {
 protected:
  void begin() {
    organs_ = OrganRegistry({1000}, ahead_);
    shapes_ = {};
  }

  /// The ticks are 1 ms apart.
  ProxyReport follow_in_tissue(ToolProxy& proxy, int tick, double hand, bool interpolates,
                               double late = 0.0) {
    const ros::Time now = ros::Time(50) + ros::Duration(1e-3 * tick);
    if (tick * 60 / 1000 != (tick - 1) * 60 / 1000 || tick == 0) {
      const auto height = static_cast<float>(kSpeed * (1e-3 * tick - late) - 0.01);
      const auto next = boost::make_shared<OrganMesh>();
      next->organ = next->header.frame_id = "liver";
      next->header.stamp = now - ros::Duration(late);
      next->triangles = {0, 1, 2};
      next->vertices = {-0.3F, -0.2F, height, 0.3F, -0.2F, height, 0.0F, 0.4F, height};
      organs_.apply(next, now);
      shapes_.update(organs_, now_);
    }
    scene_ = proxy_scene(organs_, transforms_, "liver", {}, now, [&](const auto& organ) {
      const OrganShape& latest = organ.latest();
      return Timed<std::shared_ptr<const TriangleMesh>>{
          interpolates ? shapes_.shape(organ, now_) : latest.mesh, latest.stamp};
    });
    const double behind = interpolates ? shapes_.late(*scene_.sources[0], now_) : 0.0;
    scene_.motions[0].lag_sec = (now - scene_.motions[0].stamp).toSec() + behind;
    return follow(proxy, hand, 1.0);
  }

  static constexpr double kSpeed = 0.031;  // [m/s]
  AheadLimit ahead_;
  OrganRegistry organs_{MeshLimits{1000}, ahead_};
  OrganInterpolation shapes_;
  TransformBuffer transforms_;
};

TEST_F(RisingTissueTest, InterpolatedMovesTheHandInSmallSteps) {
  for (const bool interpolates : {false, true}) {
    ToolProxy proxy(tool_, parameters_);
    begin();
    double last = 0.0, greatest = 0.0;
    for (int tick = 0; tick < 400; ++tick) {
      const ProxyReport report = follow_in_tissue(proxy, tick, 0.0, interpolates);
      if (tick > 200) greatest = std::max(greatest, std::abs(force(report) - last));
      last = force(report);
    }
    EXPECT_GT(last, 1.0) << "the tissue presses";
    if (interpolates) {
      EXPECT_LT(greatest, 0.016);
    } else {
      EXPECT_GT(greatest, 0.14);
    }
  }
}

/// The shapes are 1/60 s late. The hand rests above the tissue, which comes to it and pushes it.
TEST_F(RisingTissueTest, StaysAwayAtItsTrueTimeOnlyIfTheLagIsGuarded) {
  parameters_.clearance = 1e-3;
  for (const bool guards : {true, false}) {
    for (const bool interpolates : {false, true}) {
      SCOPED_TRACE(testing::Message() << guards << ' ' << interpolates);
      parameters_.guard_lag = guards;
      ToolProxy proxy(tool_, parameters_);
      begin();
      double least = 1.0, kept = 0.0;
      for (int tick = 0; tick < 500; ++tick) {
        const ProxyReport report =
            follow_in_tissue(proxy, tick, kRadius + 4e-3, interpolates, 1.0 / 60.0);
        EXPECT_NE(report.answer->state, ProxyStatus::kSqueezed);
        const double tissue = kSpeed * 1e-3 * tick - 0.01;
        least = std::min(least, report.proxy->axis.tip.z() - kRadius - tissue);
        if (tick > 450) kept = std::max(kept, state_of(report).contacts.at(0).clearance);
      }
      const double age = 2.0 / 60.0 + 1e-3;  // the most, with the time between ticks
      EXPECT_LT(kept, 1e-3 + (guards ? kSpeed * age : 0.0) + 1e-9);
      if (guards) {
        EXPECT_GT(least, 0.99e-3);
      } else {
        EXPECT_LT(least, 1e-3 - 0.9 * kSpeed / 60.0);
      }
    }
  }
}

// Also between shapes, against a hand that rests, goes with the tissue, or comes towards it.
TEST_F(RisingTissueTest, IsDampedByItsSpeedRelativeToTheHand) {
  parameters_.damping = 8.0;
  for (const bool interpolates : {false, true}) {
    for (const double hand : {0.0, kSpeed, -0.02}) {
      SCOPED_TRACE(testing::Message() << interpolates << ' ' << hand);
      ToolProxy proxy(tool_, parameters_);
      begin();
      const double expected = parameters_.damping * (kSpeed - hand);
      double least = 1e3, greatest = -1e3;
      for (int tick = 0; tick < 400; ++tick) {
        const double height = -0.012 + hand * 1e-3 * tick;
        const ProxyReport report = follow_in_tissue(proxy, tick, height, interpolates);
        if (tick < 100) continue;
        const double spring = parameters_.stiffness * report.answer->pull.norm();
        least = std::min(least, force(report) - spring);
        greatest = std::max(greatest, force(report) - spring);
        const std::vector<ProxyContact> places = state_of(report).contacts;
        ASSERT_FALSE(places.empty());
        EXPECT_NEAR(places[0].velocity.z, kSpeed, 0.05 * kSpeed);
      }
      EXPECT_NEAR(least, expected, 0.05 * parameters_.damping * kSpeed);
      EXPECT_NEAR(greatest, expected, 0.05 * parameters_.damping * kSpeed);
    }
  }
}

TEST(PullVelocity, IsTheDerivativeThroughALowPass) {
  struct {
    double milliseconds;  ///< since the last pose
    double pull;          ///< [m]
    bool leaps;
    double interval, slope;  ///< [s], [m/s] that the velocity follows; 0: it does not change
  } const rows[] = {
      {0.0, 0.2, false, 0.0, 0.0},
      {10.0, 0.201, false, 0.01, 0.1},
      {0.0, 0.5, false, 0.0, 0.0},  // A pose of the same time changes nothing.
      {10.0, 0.203, false, 0.01, 0.2},
      {-5000.0, 0.3, false, 0.0, 0.0},  // Time goes on from there.
      {0.4, 0.3002, false, 0.0, 0.0},   // Displacements add up.
      {0.2, 0.3012, false, 0.0006, 2.0},
      {1.0, 7.0, true, 0.0, 0.0},
      {1.0, 6.998, false, 0.001, -2.0},
  };
  PullVelocity velocity;
  ros::Time stamp(50.0);
  double expected = 0.0;
  for (const auto& row : rows) {
    stamp += ros::Duration(1e-3 * row.milliseconds);
    expected += (1.0 - std::exp(-row.interval / 2e-3)) * (row.slope - expected);
    EXPECT_NEAR(velocity.update({0.0, 0.0, row.pull}, stamp, row.leaps).z(), expected, 1e-5)
        << row.pull;
  }
}

TEST(PoseOf, IsOfTheTipOfAShaftAlongItElseOfTheFirstLink) {
  const Vector3d trocar(0.02, -0.1, 0.3), tip(-0.05, 0.07, 0.11);
  Eigen::Isometry3d pose;
  tf2::fromMsg(pose_of(shaft_tool("hook", 0.004).parameters, {{trocar, tip}}), pose);
  EXPECT_LT((pose.translation() - tip).norm(), 1e-12);
  EXPECT_LT((pose.linear().col(2) - (tip - trocar).normalized()).norm(), 1e-12);
  const Eigen::Isometry3d wrist = Eigen::Translation3d(0.4, 0.5, -0.6) *
                                  Eigen::AngleAxisd(1.1, Vector3d(0.3, -0.5, 0.8).normalized());
  tf2::fromMsg(pose_of(grasper().parameters, {{}, {wrist, Eigen::Isometry3d::Identity()}}), pose);
  EXPECT_TRUE(pose.isApprox(wrist, 1e-12));
}
