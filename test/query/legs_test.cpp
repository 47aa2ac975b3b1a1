#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "geometry/tool/leg_motion.hpp"
#include "query/leg_span.hpp"
#include "scenes.hpp"

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

Isometry3d pose(double angle, double x) {
  return Eigen::Translation3d(x, 0.0, 0.1) *
         Eigen::AngleAxisd(angle, Vector3d(1.0, 2.0, 3.0).normalized());
}

ToolWaypoint waypoint(double fraction, double angle) {
  return {fraction,
          {{0.0, 0.0, 0.0}, {0.1 * fraction, 0.2, 0.3}},
          {pose(0.1, 0.0), pose(angle, fraction)}};
}

TEST(RotationSubdivision, LeaveRotationSubdivisionAsTheyAre) {
  const ToolPath path = {waypoint(0.0, 0.0), waypoint(0.4, 0.19), waypoint(1.0, 0.3)};
  ToolPath finer;
  EXPECT_EQ(&with_subdivided_rotations(path, finer), &path);
  const ToolPath rest = {waypoint(0.0, 2.0)};
  EXPECT_EQ(&with_subdivided_rotations(rest, finer), &rest);
}

TEST(RotationSubdivision, DivideLongOnesAlongTheSameWay) {
  const ToolPath path = {waypoint(0.0, 0.0), waypoint(0.5, 0.1), waypoint(1.0, 3.0)};
  ToolPath finer;
  ASSERT_EQ(&with_subdivided_rotations(path, finer), &finer);
  EXPECT_EQ(finer.size(), 2U + 15U);
  EXPECT_EQ(finer.front().fraction, 0.0);
  EXPECT_EQ(finer.back().fraction, 1.0);
  EXPECT_EQ(finer.back().links[1].matrix(), path.back().links[1].matrix());
  const RigidMotion whole(path[1].links[1], path[2].links[1]);
  for (std::size_t i = 1; i < finer.size(); ++i) {
    const ToolWaypoint &from = finer[i - 1], &to = finer[i];
    EXPECT_GT(to.fraction, from.fraction);
    EXPECT_LE(RigidMotion(from.links[1], to.links[1]).angle(), 0.2);
    if (to.fraction <= 0.5) continue;
    const double time = 2.0 * (to.fraction - 0.5);
    EXPECT_TRUE(to.links[1].isApprox(whole.at(time), 1e-14));
    EXPECT_NEAR(to.axis.tip.x(), 0.1 * to.fraction, 1e-15);
  }
}

// A rotation by pi has no unique shortest path. Any of them may be taken.
TEST(RotationSubdivision, DivideHalfATurn) {
  ToolPath path = {waypoint(0.0, 0.0), waypoint(1.0, 0.0)};
  path[1].links[1].linear() = Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  path[0].links[1].linear().setIdentity();
  ToolPath finer;
  EXPECT_EQ(with_subdivided_rotations(path, finer).size(), 17U);
}

}  // namespace

}  // namespace organ_collision

// collision_query.hpp for paths with many waypoints, like those of a trembling hand, and for organs
// that jump during the step.

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

/// A path of `legs` legs from the start of `smooth` to its end. Each waypoint is displaced by up to
/// `tremor` [m], and each link also rotated by up to as many radians.
ToolPath trembling(const ToolPath& smooth, std::size_t legs, double tremor, Random& random) {
  ToolPath path;
  const ToolWaypoint &from = smooth.front(), &to = smooth.back();
  for (std::size_t i = 0; i <= legs; ++i) {
    const double time = static_cast<double>(i) / static_cast<double>(legs);
    ToolWaypoint waypoint{time, ShaftMotion{from.axis, to.axis}.at(time)};
    waypoint.axis.tip += tremor * random.direction();
    if (random.chance(0.5)) waypoint.axis.trocar += tremor * random.direction();
    for (std::size_t link = 0; link < from.links.size(); ++link) {
      Isometry3d pose = RigidMotion(from.links[link], to.links[link]).at(time);
      pose.translation() += tremor * random.direction();
      pose.linear() *= oracle::random_turn(tremor, random);
      waypoint.links.push_back(pose);
    }
    path.push_back(waypoint);
  }
  return path;
}

enum class Change { kNone, kShakes, kGlitches, kJumps };
constexpr std::array<Change, 4> kChanges = {Change::kNone, Change::kShakes, Change::kGlitches,
                                            Change::kJumps};

/// The organ's shape at the start of the step.
Soup changed(const Soup& soup, Change change, Random& random) {
  if (change == Change::kShakes) return shaken(soup, random.scale(1e-5, 0.01), random);
  Soup before = soup;
  const double size = random.scale(0.02, 0.2);
  if (change == Change::kGlitches) {
    for (int i = 0; i < 3; ++i) {
      const auto last = static_cast<int>(soup.vertices.size()) - 1;
      before.vertices[static_cast<std::size_t>(random.integer(0, last))] +=
          static_cast<float>(random.chance(0.3) ? 1e5 : size);
    }
  }
  if (change == Change::kJumps) {
    const Vector3d jump = size * random.direction();
    for (std::size_t i = 0; i < before.vertices.size(); ++i) {
      before.vertices[i] += static_cast<float>(jump[static_cast<Eigen::Index>(i % 3)]);
    }
  }
  return before;
}

using ManyLegsWith = CollisionQueryWith;

TEST_P(ManyLegsWith, AShaftTouchesWhatItTouchesLegByLeg) {
  Random random(21);
  std::array<std::size_t, kChanges.size()> found = {};
  for (std::size_t i = 0; i < 160 && !HasFailure(); ++i) {
    const Soup soup = scattered_faces(150, random);
    const Change change = kChanges[i % kChanges.size()];
    const TriangleMesh organ = mesh(soup), before = mesh(changed(soup, change, random));
    const ToolPath path = trembling(random_path(random.chance(0.5), random),
                                    static_cast<std::size_t>(random.integer(2, 50)),
                                    random.scale(1e-6, 3e-3), random);
    CollisionRequest request = swept(organ, path, random.scale(0.5e-3, 0.01));
    if (change != Change::kNone) request.organ_before = &before;
    const std::vector<FaceContact> all = BruteForce(request).contacts();
    expect_same(contacts(request), all, 1e-12);
    found[i % kChanges.size()] += all.size();
  }
  for (const std::size_t count : found) EXPECT_GT(count, 100U);
}

// If parts of a link touch a face at the same time, rounding decides which of them is first.
TEST_P(ManyLegsWith, LinksTouchWhatTheyTouchLegByLeg) {
  Random random(22);
  std::array<std::size_t, kChanges.size()> found = {};
  for (std::size_t i = 0; i < 60 && !HasFailure(); ++i) {
    LinkScene scene(i % 3 == 0, random, 0.1);
    const Change change = kChanges[i % kChanges.size()];
    const TriangleMesh before = mesh(changed(scene.soup, change, random));
    scene.request.organ_before = change == Change::kNone ? nullptr : &before;
    scene.request.path =
        trembling(scene.request.path, static_cast<std::size_t>(random.integer(2, 20)),
                  random.scale(1e-6, 2e-3), random);
    const std::vector<FaceContact> all = BruteForce(scene.request).contacts();
    const std::vector<FaceContact> asked = contacts(scene.request);
    ASSERT_EQ(asked.size(), all.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      EXPECT_EQ(asked[k].face, all[k].face);
      EXPECT_EQ(asked[k].link, all[k].link);
      EXPECT_NEAR(asked[k].fraction, all[k].fraction, 1e-6);
    }
    found[i % kChanges.size()] += all.size();
  }
  for (const std::size_t count : found) EXPECT_GT(count, 100U);
}

// Meshes that were created separately do not share their clusters.
TEST_P(ManyLegsWith, ShapesNeedNotShareTheirClusters) {
  Random random(23);
  for (int i = 0; i < 20 && !HasFailure(); ++i) {
    const Soup soup = scattered_faces(400, random);
    const Soup before = changed(soup, Change::kShakes, random);
    const TriangleMesh organ = mesh(soup), alone = mesh(before);
    TriangleMesh sharing = organ;
    sharing.move_vertices(before.vertices);
    CollisionRequest request = swept(organ, random_path(true, random), 0.005);
    request.organ_before = &alone;
    const std::vector<FaceContact> expected = contacts(request);
    request.organ_before = &sharing;
    expect_same(contacts(request), expected, 0.0);
  }
}

// A region is clipped to the volume of the leg and link of the first touch.
TEST_P(ManyLegsWith, RegionsAreThoseOfTheLegThatTouched) {
  Random random(24);
  std::size_t compared = 0;
  for (int i = 0; i < 20 && !HasFailure(); ++i) {
    LinkScene scene(false, random, 0.1);
    scene.request.organ_before = nullptr;
    scene.request.path = trembling(scene.request.path, 6, 5e-3, random);
    scene.request.regions = true;
    query_.evaluate(scene.request, result_);
    const CollisionResult whole = result_;
    ASSERT_EQ(whole.regions.size(), whole.contacts.size());
    for (std::size_t k = 0; k < whole.contacts.size(); ++k) {
      const double fraction = whole.contacts[k].fraction;
      std::size_t leg = 1;
      while (leg + 1 < scene.request.path.size() && scene.request.path[leg].fraction < fraction) {
        ++leg;
      }
      CollisionRequest alone = scene.request;
      alone.path = {scene.request.path[leg - 1], scene.request.path[leg]};
      alone.path[0].fraction = 0.0;
      alone.path[1].fraction = 1.0;
      query_.evaluate(alone, result_);
      for (std::size_t n = 0; n < result_.contacts.size(); ++n) {
        if (result_.contacts[n].face != whole.contacts[k].face) continue;
        if (result_.contacts[n].link != whole.contacts[k].link) continue;
        ASSERT_EQ(result_.regions[n].size(), whole.regions[k].size());
        for (std::size_t c = 0; c < whole.regions[k].size(); ++c) {
          EXPECT_LE((result_.regions[n][c] - whole.regions[k][c]).norm(), 1e-6);
        }
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 300U);
}

INSTANTIATE_TEST_SUITE_P(Pickers, ManyLegsWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace

}  // namespace organ_collision
