#include "query/leg_span.hpp"

#include <gtest/gtest.h>

#include "geometry/tool/rigid_motion.hpp"
#include "link_scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

constexpr int kSamples = 20;

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
    next.links[0].translation() += drift + tremor * random.direction();
    next.links[0].linear() *= turn * oracle::random_turn(tremor, random);
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

TEST(LegSpan, NoPointOfAShaftIsFartherFromItsChordThanTheDeviation) {
  Random random(1);
  std::size_t shared = 0;
  for (int i = 0; i < 300; ++i) {
    const ToolPath path = wandering(40, random.scale(1e-7, 1e-3), random);
    const double allowed = random.scale(1e-5, 1e-2);
    for (std::size_t leg = 0; leg + 1 < path.size();) {
      const LegSpan span = shaft_span(path.data(), path.size(), leg, allowed);
      ASSERT_EQ(span.begin, leg);
      ASSERT_GT(span.end, leg);
      ASSERT_LT(span.end, path.size());
      EXPECT_LE(span.deviation, allowed);
      shared += span.leg_count() > 1;
      const ShaftMotion chord{path[span.begin].axis, path[span.end].axis};
      for_each_time(path, span, [&](std::size_t on, double time, double chord_time) {
        const ShaftAxis axis = ShaftMotion{path[on].axis, path[on + 1].axis}.at(time);
        const ShaftAxis on_chord = chord.at(chord_time);
        for (const double place : {0.0, 0.3, 1.0}) {
          ASSERT_LE((axis.at(place) - on_chord.at(place)).norm(), span.deviation + 1e-12);
        }
      });
      leg = span.end;
    }
  }
  EXPECT_GT(shared, 500U);
}

TEST(LegSpan, NoPointOfALinkIsFartherFromItsChordThanTheDeviation) {
  Random random(2);
  std::size_t shared = 0;
  for (int i = 0; i < 300; ++i) {
    const ToolPath path = wandering(40, random.scale(1e-7, 1e-3), random);
    const Link link{"jaw", {random_part(false, random), random_part(false, random)}};
    const LinkBall ball = ball_around(link);
    const double allowed = random.scale(1e-5, 1e-2);
    for (std::size_t leg = 0; leg + 1 < path.size();) {
      const LegSpan span = link_span(path.data(), path.size(), leg, 0, ball, allowed);
      ASSERT_EQ(span.begin, leg);
      ASSERT_GT(span.end, leg);
      EXPECT_LE(span.deviation, allowed);
      shared += span.leg_count() > 1;
      const RigidMotion chord(path[span.begin].links[0], path[span.end].links[0]);
      for_each_time(path, span, [&](std::size_t on, double time, double chord_time) {
        const Isometry3d pose = RigidMotion(path[on].links[0], path[on + 1].links[0]).at(time);
        const Isometry3d on_chord = chord.at(chord_time);
        for (const LinkPart& part : link.parts) {
          for (std::size_t k = 0; k < part.core.count; ++k) {
            const Vector3d& point = part.core.points[k];
            ASSERT_LE((pose * point - on_chord * point).norm(), span.deviation + 1e-12);
          }
        }
      });
      leg = span.end;
    }
  }
  EXPECT_GT(shared, 500U);
}

TEST(LegSpan, AStraightWayIsOneSpan) {
  Random random(3);
  const ShaftMotion motion{random_axis(random), random_axis(random)};
  ToolPath path;
  for (int i = 0; i <= 64; ++i) path.push_back({i / 64.0, motion.at(i / 64.0)});
  const LegSpan span = shaft_span(path.data(), path.size(), 0, 1e-9);
  EXPECT_EQ(span.end, 64U);
  EXPECT_LE(span.deviation, 1e-15);
}

TEST(LegSpan, AToolAtRestHasOneLeg) {
  Random random(4);
  const ToolPath path = {{0.0, random_axis(random), {Isometry3d::Identity()}}};
  const Link link{"jaw", {random_part(false, random)}};
  for (const LegSpan& span : {shaft_span(path.data(), 1, 0, 1.0),
                              link_span(path.data(), 1, 0, 0, ball_around(link), 1.0)}) {
    EXPECT_EQ(span.leg_count(), 1U);
    EXPECT_EQ(span.deviation, 0.0);
  }
}

TEST(LegSpan, TheBallHoldsAllPartsOfTheLink) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    Link link{"jaw", {}};
    for (int k = 0; k < 3; ++k) link.parts.push_back(random_part(false, random));
    const LinkBall ball = ball_around(link);
    for (const LinkPart& part : link.parts) {
      const double farthest =
          part.project_onto((part.bounds.center - ball.center).normalized()).high;
      EXPECT_LE(farthest - ball.center.dot((part.bounds.center - ball.center).normalized()),
                ball.radius + 1e-12);
    }
    EXPECT_GT(allowed_deviation(link), 0.0);
  }
}

}  // namespace
}  // namespace organ_collision
