// Links: the shapes of their parts, and their motion on a leg.
#include "organ_collision/geometry/tool/link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/distance/closest_points.hpp"
#include "geometry/tool/leg_motion.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/link_trials.hpp"
#include "test/proof/step_oracle.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::LinkTrial;
using oracle::Random;

/// [m] The distance of a centred shape, with its axes along x, y and z, from a point in its frame.
double box_distance(const Vector3d& size, const Vector3d& point) {
  return (point.cwiseAbs() - 0.5 * size).cwiseMax(0.0).norm();
}
double cylinder_distance(double radius, double length, const Vector3d& point) {
  return std::hypot(std::max(0.0, point.head<2>().norm() - radius),
                    std::max(0.0, std::abs(point.z()) - 0.5 * length));
}

/// Checks that the part's bounds contain its core and touch it on all six sides.
void expect_tight_bounds(const LinkPart& part) {
  const OrientedBox& box = part.bounds;
  EXPECT_LE((box.axes * box.axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_GT(box.axes.determinant(), 0.0);
  for (int i = 0; i < 3; ++i) {
    const Vector3d axis = box.axes.col(i);
    const double middle = axis.dot(box.center);
    EXPECT_NEAR(part.project_onto(axis).high, middle + box.half_size[i], 1e-15);
    EXPECT_NEAR(part.project_onto(-axis).high, box.half_size[i] - middle, 1e-15);
  }
}

// A cylinder is along z and flat-ended. A box has its sizes along its axes.
TEST(LinkPart, HasItsShapeAtItsPose) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Isometry3d pose = oracle::random_pose(0.1, random);
    const Vector3d size(random.scale(1e-4, 0.3), random.scale(1e-4, 0.3), random.scale(1e-4, 0.3));
    const double radius = 0.5 * size.x();
    const LinkPart box = LinkPart::box(pose, size);
    const LinkPart cylinder = LinkPart::cylinder(pose, radius, size.z());
    EXPECT_TRUE(cylinder.core.is_cylinder());
    EXPECT_FALSE(box.core.is_cylinder());
    for (const LinkPart& part : {box, cylinder}) {
      EXPECT_EQ(part.radius, tolerance::kConvexMargin);
      EXPECT_EQ(part.surface, nullptr);
      expect_tight_bounds(part);
    }
    for (int k = 0; k < 20; ++k) {
      const Vector3d in_shape = size.cwiseProduct(random.point(1.2)), point = pose * in_shape;
      const auto distance = [&](const LinkPart& part) {
        return closest_points(part.core, Triangle{point, point, point}).distance;
      };
      EXPECT_NEAR(distance(box), box_distance(size, in_shape), 1e-12);
      EXPECT_NEAR(distance(cylinder), cylinder_distance(radius, size.z(), in_shape), 1e-11);
    }
  }
}

class ConvexCoreOf : public testing::TestWithParam<std::size_t> {};

TEST_P(ConvexCoreOf, SupportIsItsFarthestPoint) {
  Random random(10 + GetParam());
  for (int i = 0; i < 300; ++i) {
    const ConvexCore core = oracle::make_core(GetParam(), random);
    const bool is_along = random.chance(0.2);  // For some cores this is the axis.
    const Vector3d direction = is_along ? Vector3d(core.points[core.count - 1] - core.points[0])
                                        : Vector3d(random.scale(1e-12, 1e6) * random.direction());
    const Vector3d support = core.support(direction);
    EXPECT_LE(oracle::distance(core, support), 4e-15);
    EXPECT_EQ(core.support_value(direction), direction.dot(support));
    for (int k = 0; k < 200; ++k) {
      const double angle = 2.0 * M_PI * k / 200;
      const Vector3d on_rim = core.rim * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const double other = direction.dot(core.points[k % core.count] + on_rim);
      EXPECT_GE(core.support_value(direction), other - 1e-15 * direction.norm());
    }
  }
}

// A link turns at constant speed the shorter way, as quaternions do. Half a turn may go either way.
TEST(RigidMotion, InterpolatesPosesAsQuaternionsDo) {
  Random random(1);
  for (const double angle : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 1.0, 2.0, 3.0, 3.14159, M_PI}) {
    for (int i = 0; i < 100; ++i) {
      const Isometry3d start = oracle::random_pose(0.3, random);
      Isometry3d end = oracle::random_pose(0.3, random);
      end.linear() = start.linear() * oracle::random_turn(angle, random);
      const RigidMotion motion(start, end);
      EXPECT_NEAR(motion.angle(), angle, 1e-14);
      EXPECT_NEAR(motion.farthest_move(Eigen::Vector3d::Zero(), 0.0),
                  (start.translation() - end.translation()).norm(), 1e-15);
      EXPECT_EQ(motion.rests(), start.matrix() == end.matrix());
      EXPECT_LE((motion.at(0.0).matrix() - start.matrix()).norm(), 2e-15);
      EXPECT_LE((motion.at(1.0).matrix() - end.matrix()).norm(), 2e-15);
      // There is no jump at the ends.
      EXPECT_LE((motion.at(1e-12).matrix() - start.matrix()).norm(), 2e-11);
      EXPECT_LE((motion.at(1.0 - 1e-12).matrix() - end.matrix()).norm(), 2e-11);
      const double time = random.uniform(0.0, 1.0);
      const Eigen::Quaterniond begun(start.linear()), turned(motion.at(time).linear());
      EXPECT_NEAR(begun.angularDistance(turned), time * angle, 1e-7);
      if (angle == M_PI) continue;
      const Isometry3d expected = oracle::between(start, end, time);
      EXPECT_LE((motion.at(time).matrix() - expected.matrix()).norm(), 1e-9);
    }
  }
}

/// Support points of the core, for the same directions of the link at every pose.
std::vector<Vector3d> points_of(const ConvexCore& core, const Eigen::Isometry3d& pose) {
  Random random(5);
  std::vector<Vector3d> points;
  for (int i = 0; i < 30; ++i) points.push_back(pose * core.support(random.direction()));
  return points;
}

/// The motion of a link behind one to four joints that turn and move.
RigidMotion on_joints(Random& random) {
  const double most = random.scale(1e-3, 3.0);
  std::vector<Isometry3d> start, end;
  for (int joint = random.integer(1, 4); joint > 0; --joint) {
    start.push_back(oracle::random_pose(random.scale(1e-4, 0.3), random));
    end.push_back(start.back());
    end.back().linear() *= oracle::random_turn(random.uniform(0.0, most), random);
    end.back().translation() += random.scale(1e-5, 0.05) * random.direction();
  }
  const ChainMotion whole{std::make_shared<JointChain>(start, end)};
  const double begin = random.uniform(0.0, 0.9);
  const ChainMotion joints = whole.part(begin, random.uniform(begin, 1.0));
  return {joints.at(0.0), joints.at(1.0), joints};
}

TEST_P(ConvexCoreOf, MovesNoFartherThanItsBounds) {
  Random random(40 + GetParam());
  for (int i = 0; i < 400; ++i) {
    const LinkTrial trial = oracle::make_link_trial(0, GetParam(), random);
    const RigidMotion motion = i % 2 == 0 ? trial.motion() : on_joints(random);
    const CoreMotion core(trial.core, motion);
    const double from = random.uniform(0.0, 1.0), to = random.uniform(from, 1.0);
    const auto first = points_of(trial.core, motion.at(from));
    const auto last = points_of(trial.core, motion.at(to));
    constexpr int kSteps = 50;
    std::vector<Vector3d> before = first;
    for (int step = 0; step <= kSteps; ++step) {
      const double share = static_cast<double>(step) / kSteps;
      const auto now = points_of(trial.core, motion.at(from + share * (to - from)));
      for (std::size_t k = 0; k < now.size(); ++k) {
        EXPECT_LE((now[k] - before[k]).norm(), core.farthest_move() * (to - from) / kSteps + 1e-14)
            << "at any time, not on average";
        const Vector3d on_chord = (1.0 - share) * first[k] + share * last[k];
        EXPECT_LE((now[k] - on_chord).norm(),
                  4.0 * share * (1.0 - share) * core.chord_deviation(to - from) + 1e-15);
      }
      before = now;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ConvexCoreOf, testing::Range<std::size_t>(0, oracle::kCoreKinds));

TEST(CoreMotion, OfAShaftHasNoChordDeviation) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const ShaftMotion shaft = oracle::make_trial(0, random).motion;
    const CoreMotion core(shaft);
    EXPECT_EQ(core.link(), nullptr);
    EXPECT_EQ(core.chord_deviation(1.0), 0.0);
    EXPECT_EQ(core.farthest_move(), std::max((shaft.end.tip - shaft.start.tip).norm(),
                                             (shaft.end.trocar - shaft.start.trocar).norm()));
  }
}

}  // namespace
}  // namespace organ_collision
