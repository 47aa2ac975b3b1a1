// collision_query.hpp for paths with many waypoints, like those of a trembling hand, and for organs
// that jump during the step.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "link_scenes.hpp"

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
