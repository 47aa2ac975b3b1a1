// step.hpp: no point of a part is farther from its chord than a span says.
#include <gtest/gtest.h>

#include "geometry/tool/leg_motion.hpp"
#include "query/step.hpp"
#include "scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

constexpr int kSamples = 20;

/// The motion of two joints that turn.
ChainMotion chain(const std::vector<Isometry3d>& start, const Eigen::Matrix3d& first,
                  const Eigen::Matrix3d& second) {
  std::vector<Isometry3d> end = start;
  end[0].linear() *= first;
  end[1].linear() *= second;
  return {std::make_shared<JointChain>(start, end)};
}

/// A path of a shaft and one link that drift, rotate and tremble.
ToolPath wandering(std::size_t count, double tremor, Random& random) {
  ToolPath path = {{0.0, random_axis(random), {oracle::random_pose(0.1, random)}}};
  const Vector3d drift = random.scale(1e-6, 1e-3) * random.direction();
  const Eigen::AngleAxisd turn(random.scale(1e-6, 0.02), random.direction());
  for (std::size_t i = 1; i < count; ++i) {
    ToolWaypoint next = path.back();
    next.fraction = static_cast<double>(i) / static_cast<double>(count - 1);
    next.axis.tip += drift + tremor * random.direction();
    next.axis.trocar += tremor * random.direction();
    for (ShaftArc& arc : next.arcs) {
      const auto turned = oracle::random_turn(random.scale(1e-6, 0.1), random);
      const auto along = oracle::random_turn(random.scale(1e-6, 0.1), random);
      arc = ShaftArc(chain({oracle::random_pose(0.1, random), oracle::random_pose(0.2, random)},
                           turned, along),
                     random.point(0.2));
    }
    next.links[0].translation() += drift + tremor * random.direction();
    next.links[0].linear() *= turn * oracle::random_turn(tremor, random);
    next.joints.clear();
    if (i % 3 == 0) {
      const Isometry3d& before = path.back().links[0];
      const Isometry3d last = oracle::random_pose(0.02, random);
      const ChainMotion joints = chain({before * last.inverse(), last}, Isometry3d(turn).linear(),
                                       oracle::random_turn(tremor, random));
      next.links[0] = joints.at(1.0);
      next.joints = {joints};
    }
    path.push_back(next);
  }
  return path;
}

/// Calls visit(leg, time on the leg, time on the chord) for several times of each leg of a span.
template <typename Visit>
void for_each_time(const ToolPath& path, const LegSpan& span, Visit visit) {
  const double begin = path[span.begin].fraction, end = path[span.end].fraction;
  for (std::size_t leg = span.begin; leg < span.end; ++leg) {
    for (int k = 0; k <= kSamples; ++k) {
      const double time = static_cast<double>(k) / kSamples;
      const double fraction =
          path[leg].fraction + time * (path[leg + 1].fraction - path[leg].fraction);
      visit(leg, time, (fraction - begin) / (end - begin));
    }
  }
}

/// Divides random paths into the spans that `next_span(path, leg, allowed)` gives, and compares
/// each with `farthest(path, span)`, the largest deviation that is seen.
template <typename NextSpan, typename Farthest>
void expect_bounds(Random& random, NextSpan next_span, Farthest farthest) {
  std::size_t shared = 0;
  for (int i = 0; i < 300; ++i) {
    const ToolPath path = wandering(40, random.scale(1e-7, 1e-3), random);
    const double allowed = random.scale(1e-5, 1e-2);
    for (std::size_t leg = 0; leg + 1 < path.size();) {
      const LegSpan span = next_span(path, leg, allowed);
      ASSERT_EQ(span.begin, leg);
      ASSERT_GT(span.end, leg);
      ASSERT_LT(span.end, path.size());
      EXPECT_LE(span.deviation, allowed);
      EXPECT_LE(farthest(path, span), span.deviation + 1e-12);
      shared += span.leg_count() > 1;
      leg = span.end;
    }
  }
  EXPECT_GT(shared, 500U);
}

TEST(LegSpan, BoundsHowFarAShaftIsFromItsChord) {
  Random random(1);
  const auto next_span = [](const ToolPath& path, std::size_t leg, double allowed) {
    return shaft_span(path.data(), path.size(), leg, allowed);
  };
  expect_bounds(random, next_span, [](const ToolPath& path, const LegSpan& span) {
    ShaftMotion chord{path[span.begin].axis, path[span.end].axis};
    if (span.leg_count() == 1) chord.arcs = path[span.end].arcs;  // As Step::shaft_motion() does.
    double most = 0.0;
    for_each_time(path, span, [&](std::size_t on, double time, double chord_time) {
      const ShaftAxis axis =
          ShaftMotion{path[on].axis, path[on + 1].axis, path[on + 1].arcs}.at(time);
      const ShaftAxis on_chord = chord.at(chord_time);
      for (const double place : {0.0, 0.3, 1.0}) {
        most = std::max(most, (axis.at(place) - on_chord.at(place)).norm());
      }
    });
    return most;
  });
}

TEST(LegSpan, BoundsHowFarALinkIsFromItsChord) {
  Random random(2);
  Link link;
  const auto next_span = [&](const ToolPath& path, std::size_t leg, double allowed) {
    if (leg == 0) link.parts = {random_part(false, random), random_part(false, random)};
    return link_span(path.data(), path.size(), leg, 0, ball_around(link), allowed);
  };
  expect_bounds(random, next_span, [&](const ToolPath& path, const LegSpan& span) {
    const RigidMotion chord(path[span.begin].links[0], path[span.end].links[0]);
    EXPECT_LE(chord.angle(), 1.01 * kMaxRotation);
    double most = 0.0;
    for_each_time(path, span, [&](std::size_t on, double time, double chord_time) {
      const auto& joints = path[on + 1].joints;
      const Isometry3d pose = RigidMotion(path[on].links[0], path[on + 1].links[0],
                                          joints.empty() ? ChainMotion{} : joints[0])
                                  .at(time);
      const Isometry3d on_chord =
          span.leg_count() == 1 ? pose : chord.at(chord_time);  // As Step::link_motion() does.
      for (const LinkPart& part : link.parts) {
        for (std::size_t k = 0; k < part.core.count; ++k) {
          const Vector3d& point = part.core.points[k];
          most = std::max(most, (pose * point - on_chord * point).norm());
        }
      }
    });
    return most;
  });
}

TEST(LegSpan, AStraightWayIsOneSpanAndAToolAtRestHasOneLeg) {
  Random random(3);
  const ShaftMotion motion{random_axis(random), random_axis(random)};
  ToolPath path;
  for (int i = 0; i <= 64; ++i) path.push_back({i / 64.0, motion.at(i / 64.0)});
  const LegSpan span = shaft_span(path.data(), path.size(), 0, 1e-9);
  EXPECT_EQ(span.end, 64U);
  EXPECT_LE(span.deviation, 1e-15);
  const ToolPath rest = {{0.0, random_axis(random), {Isometry3d::Identity()}}};
  const Link link{"jaw", {random_part(false, random)}};
  for (const LegSpan& alone : {shaft_span(rest.data(), 1, 0, 1.0),
                               link_span(rest.data(), 1, 0, 0, ball_around(link), 1.0)}) {
    EXPECT_EQ(alone.leg_count(), 1U);
    EXPECT_EQ(alone.deviation, 0.0);
  }
}

TEST(RotationSubdivision, DividesLongRotationsAlongTheSameWay) {
  const auto waypoint = [](double fraction, double angle) {
    const Eigen::AngleAxisd turn(angle, Vector3d(1.0, 2.0, 3.0).normalized());
    return ToolWaypoint{fraction,
                        {{0.0, 0.0, 0.0}, {0.1 * fraction, 0.2, 0.3}},
                        {Isometry3d::Identity(), Eigen::Translation3d(fraction, 0.0, 0.1) * turn}};
  };
  ToolPath finer;
  const ToolPath small = {waypoint(0.0, 0.0), waypoint(0.4, 0.19), waypoint(1.0, 0.3)};
  EXPECT_EQ(&with_subdivided_rotations(small, finer), &small);
  const ToolPath rest = {waypoint(0.0, 2.0)};
  EXPECT_EQ(&with_subdivided_rotations(rest, finer), &rest);

  const ToolPath path = {waypoint(0.0, 0.0), waypoint(0.5, 0.1), waypoint(1.0, 3.0)};
  ASSERT_EQ(&with_subdivided_rotations(path, finer), &finer);
  EXPECT_EQ(finer.size(), 2U + 15U);
  EXPECT_EQ(finer.back().links[1].matrix(), path.back().links[1].matrix());
  const RigidMotion whole(path[1].links[1], path[2].links[1]);
  for (std::size_t i = 1; i < finer.size(); ++i) {
    const ToolWaypoint &from = finer[i - 1], &to = finer[i];
    EXPECT_GT(to.fraction, from.fraction);
    EXPECT_LE(RigidMotion(from.links[1], to.links[1]).angle(), kMaxRotation);
    if (to.fraction <= 0.5) continue;
    EXPECT_TRUE(to.links[1].isApprox(whole.at(2.0 * (to.fraction - 0.5)), 1e-14));
    EXPECT_NEAR(to.axis.tip.x(), 0.1 * to.fraction, 1e-15);
  }

  // A shaft whose tip is carried along moves as before, too, and so does a link on joints.
  const ChainMotion joints =
      chain({Isometry3d(Eigen::Translation3d(0.1, -0.3, 0.2)),
             Isometry3d(Eigen::Translation3d(0.1, 0.0, 0.1))},
            Eigen::AngleAxisd(1.9, Vector3d(0.6, 0.0, 0.8)).toRotationMatrix(),
            Eigen::AngleAxisd(1.0, Vector3d(0.0, 1.0, 0.0)).toRotationMatrix());
  const ShaftArc arc(joints, {0.1, -0.3, 0.2});
  ToolPath carried = {
      {0.0, {{0.0, 0.0, 0.0}, {0.1, 0.2, 0.3}}, {joints.at(0.0)}},
      {1.0, {{0.0, 0.1, 0.0}, {0.3, 0.1, 0.3}}, {joints.at(1.0)}, {ShaftArc{}, arc}, {joints}}};
  const ShaftMotion motion{carried[0].axis, carried[1].axis, carried[1].arcs};
  ASSERT_EQ(with_subdivided_rotations(carried, finer).size(), 16U);
  for (std::size_t i = 1; i < finer.size(); ++i) {
    const ShaftMotion leg{finer[i - 1].axis, finer[i].axis, finer[i].arcs};
    EXPECT_LE(leg.arcs[1].angle(), kMaxRotation);
    for (const double time : {0.0, 0.3, 1.0}) {
      const ShaftAxis right =
          motion.at(finer[i - 1].fraction + time * (finer[i].fraction - finer[i - 1].fraction));
      EXPECT_LE((leg.at(time).tip - right.tip).norm(), 2e-15);
      EXPECT_LE((leg.at(time).trocar - right.trocar).norm(), 1e-15);
      const double now = finer[i - 1].fraction + time * (finer[i].fraction - finer[i - 1].fraction);
      const RigidMotion link(finer[i - 1].links[0], finer[i].links[0], finer[i].joints[0]);
      EXPECT_TRUE(link.at(time).isApprox(joints.at(now), 1e-14));
    }
  }

  // A rotation by pi has no unique shortest path. Any of them may be taken.
  ToolPath half = {waypoint(0.0, 0.0), waypoint(1.0, 0.0)};
  half[1].links[1].linear() = Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  EXPECT_EQ(with_subdivided_rotations(half, finer).size(), 17U);
}

}  // namespace
}  // namespace organ_collision
