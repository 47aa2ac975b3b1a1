// The parts of a haptic proxy that have tests of their own: the solver, the ways in which a tool
// can move, the crossings of several organs, the tissue nearby, and the bound of the work.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/tool/leg_motion.hpp"
#include "proxy_scenes.hpp"
#include "query/proxy/least_constraint.hpp"
#include "query/proxy/mobility.hpp"
#include "query/proxy/proxy_motion.hpp"
#include "query/proxy/tissue.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

Displacement random_displacement(Random& random, double scale, int dimensions) {
  Displacement result = Displacement::Zero();
  for (int i = 0; i < dimensions; ++i) result[i] = random.uniform(-scale, scale);
  return result;
}

/// Walls that leave room for the origin.
std::vector<Wall> random_walls(Random& random, std::size_t count, int dimensions) {
  std::vector<Wall> walls;
  for (std::size_t i = 0; i < count; ++i) {
    walls.push_back({random_displacement(random, 1.0, dimensions), random.uniform(0.0, 1e-3)});
  }
  return walls;
}

/// The conditions of Karush, Kuhn and Tucker, which hold nowhere else for a convex problem.
TEST(LeastConstraint, IsOptimalInSixDimensions) {
  Random random(3);
  LeastConstraint solver;
  for (int trial = 0; trial < 2000; ++trial) {
    const Displacement goal = random_displacement(random, 0.02, 6);
    const std::vector<Wall> walls = random_walls(random, random.integer(1, 200), 6);
    solver.solve(goal, walls);
    Displacement rest = goal - solver.displacement();
    double loads = 0.0;
    for (std::size_t i = 0; i < walls.size(); ++i) {
      const double room = walls[i].bound - walls[i].row.dot(solver.displacement());
      EXPECT_GE(solver.load(i), 0.0);
      EXPECT_GT(room, -solver.violation() - 1e-11);
      const double used = solver.load(i) > 0.0 ? std::abs(room) : 0.0;
      EXPECT_LT(used, solver.violation() + 1e-11);
      rest -= solver.load(i) * walls[i].row;
      loads += solver.load(i);
    }
    EXPECT_LT(rest.norm(), 1e-10) << "trial " << trial;
    EXPECT_NEAR(solver.violation(), 1e-6 * loads, 1e-3 * solver.violation() + 1e-12);
  }
}

TEST(LeastConstraint, ViolatesOppositeWallsEqually) {
  Random random(4);
  LeastConstraint solver;
  for (int trial = 0; trial < 500; ++trial) {
    const Displacement across = random_displacement(random, 1.0, 6).normalized();
    const double overlap = random.scale(1e-6, 1e-3), place = random.uniform(-1e-3, 1e-3);
    const Displacement goal = random_displacement(random, 0.01, 6);
    solver.solve(goal, {{across, place - overlap}, {-across, -place - overlap}});
    EXPECT_NEAR(solver.violation(), overlap, 1e-7);
    EXPECT_NEAR(across.dot(solver.displacement()), place, 1e-7);
    // It goes to the goal in all other directions.
    const Displacement left = goal - solver.displacement();
    EXPECT_LT((left - left.dot(across) * across).norm(), 1e-9);
  }
}

TEST(LeastConstraint, CopesWithEqualWallsAndRowsOfZeros) {
  Random random(5);
  LeastConstraint solver;
  const Displacement row = random_displacement(random, 1.0, 6).normalized();
  std::vector<Wall> walls(300, Wall{row, 0.001});
  walls.push_back({Displacement::Zero(), 0.0});
  walls.push_back({1e-9 * row, 1.0});
  solver.solve(0.01 * row, walls);
  EXPECT_LT((solver.displacement() - 0.001 * row).norm(), 1e-7);
  double loads = 0.0;
  for (std::size_t i = 0; i < walls.size(); ++i) loads += solver.load(i);
  EXPECT_NEAR(loads, 0.009, 1e-7);
}

Isometry3d random_pose(Random& random, double range) {
  Isometry3d pose(Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.direction()));
  pose.translation() = random.point(range);
  return pose;
}

Link box_link(Random& random) {
  return {"link", {LinkPart::box(random_pose(random, 0.01), Vector3d(0.01, 0.02, 0.03))}};
}

ProxyTool shaft(ProxyFreedom freedom) { return {0.003, {}, freedom}; }

ProxyTool tool_of_links(Random& random, double radius, ProxyFreedom freedom) {
  return {radius, {box_link(random), box_link(random)}, freedom};
}

ToolPose random_hand(const ProxyTool& tool, Random& random) {
  ToolPose hand{{random.point(0.1) + Vector3d(0.0, 0.0, 0.2), random.point(0.1)}, {}, {}};
  for (std::size_t link = 0; link < tool.links.size(); ++link) {
    hand.links.push_back(random_pose(random, 0.05));
  }
  return hand;
}

Displacement random_displacement(const ProxyTool& tool, Random& random, double scale) {
  Displacement result = Displacement::Zero();
  result.head<3>() = random.point(scale);
  if (tool.freedom == ProxyFreedom::kFree) result.tail<3>() = random.point(scale);
  return result;
}

double difference(const ToolPose& a, const ToolPose& b) {
  double most = std::max((a.axis.trocar - b.axis.trocar).norm(), (a.axis.tip - b.axis.tip).norm());
  for (std::size_t link = 0; link < a.links.size(); ++link) {
    most = std::max(most, (a.links[link].matrix() - b.links[link].matrix()).norm());
  }
  return most;
}

std::vector<ProxyTool> tools(Random& random) {
  return {shaft(ProxyFreedom::kTrocar), shaft(ProxyFreedom::kFree),
          tool_of_links(random, 0.0, ProxyFreedom::kFree),
          tool_of_links(random, 0.004, ProxyFreedom::kFree),
          tool_of_links(random, 0.004, ProxyFreedom::kTrocar)};
}

TEST(Mobility, TakesTrocarAndJointsFromTheHand) {
  Random random(2);
  for (const ProxyTool& tool : tools(random)) {
    const auto mobility = make_mobility(tool);
    const ToolPose before = random_hand(tool, random), hand = random_hand(tool, random);
    mobility->measure(hand);
    const ToolPose pose = mobility->combine(before, hand);
    if (tool.freedom == ProxyFreedom::kTrocar) {
      EXPECT_EQ(pose.axis.trocar, hand.axis.trocar);
      EXPECT_EQ(pose.axis.tip, before.axis.tip);
    }
    for (std::size_t link = 1; link < tool.links.size(); ++link) {
      const Isometry3d joint = hand.links[0].inverse() * hand.links[link];
      EXPECT_LT(((pose.links[0] * joint).matrix() - pose.links[link].matrix()).norm(), 1e-12);
    }
    if (!tool.links.empty() && tool.freedom == ProxyFreedom::kFree) {
      EXPECT_LT((pose.links[0].linear() - before.links[0].linear()).norm(), 1e-12);
    }
    EXPECT_LT(difference(mobility->combine(hand, hand), hand), 1e-12);
  }
}

TEST(Mobility, NoPointMovesFartherThanTheLongestWay) {
  Random random(4);
  for (const ProxyTool& tool : tools(random)) {
    const auto mobility = make_mobility(tool);
    for (int trial = 0; trial < 200; ++trial) {
      const ToolPose hand = random_hand(tool, random);
      mobility->measure(hand);
      const Displacement by = random_displacement(tool, random, 0.003);
      const ToolPose moved = mobility->moved(hand, by, hand);
      double most = 0.0;
      if (tool.radius > 0.0) most = (moved.axis.tip - hand.axis.tip).norm();
      for (std::size_t link = 0; link < tool.links.size(); ++link) {
        const OrientedBox& box = tool.links[link].parts[0].bounds;
        for (int corner = 0; corner < 8; ++corner) {
          const Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
          const Vector3d point = box.center + box.axes * box.half_size.cwiseProduct(sign);
          most = std::max(most, (moved.links[link] * point - hand.links[link] * point).norm());
        }
      }
      EXPECT_LE(most, 1.1 * mobility->longest_way(hand, by));
    }
  }
}

TEST(Tissue, HasTheCrossingsOfAllOrgansInTheirOrderAlongTheAxis) {
  const ProxyTool tool = shaft_tool();
  Tissue tissue(tool, PickerKind::kFeedback);
  std::vector<OrganTick> organs;
  const ProxyOrgan shapes[] = {organ_of(flat_sheet(7, 0.01)), organ_of(flat_sheet(7, 0.05)),
                               organ_of(sphere(9, 12, 0.03))};
  for (const ProxyOrgan& organ : shapes) {
    OrganTick& tick = organs.emplace_back();
    tick.before = tick.now = organ.shape.get();
  }
  tissue.set_organs(organs);
  const auto crossings = tissue.cross({{0.001, 0.002, 0.1}, {0.003, 0.001, -0.1}});
  ASSERT_EQ(crossings.size(), 4u);
  EXPECT_EQ(crossings[0].organ, 1u);
  EXPECT_EQ(crossings[1].organ, 2u);
  EXPECT_EQ(crossings[2].organ, 0u);
  EXPECT_EQ(crossings[3].organ, 2u);
  EXPECT_NEAR(crossings[0].point.z(), 0.05, 1e-7);
}

/// An organ that rests.
OrganTick resting(const ProxyOrgan& organ) {
  OrganTick tick;
  tick.before = tick.now = organ.shape.get();
  return tick;
}

/// A sphere with bumps and hollows.
GridSurface bumpy_sphere(Random& random) {
  GridSurface surface = sphere(40, 70, 0.05);
  for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> at(&surface.vertices[i]);
    at *= 1.0F + 0.05F * std::sin(90.0F * at.x()) * std::cos(70.0F * at.y()) +
          static_cast<float>(random.uniform(-2e-3, 2e-3));
  }
  return surface;
}

/// Whether a face that a look found is the other one, or stands for it: a tool that stays on this
/// side of the plane through the place found keeps away from the whole other face, and the places
/// are near each other. The allowances are larger than those of patch_finder.cpp, because the face
/// that covered the other one may itself be covered.
bool covers(const TissueContact& found, const TissueContact& other, const TriangleMesh& shape,
            const PatchFinder::Limits& limits) {
  if (found.contact.link != other.contact.link) return false;
  if (found.contact.face == other.contact.face) return true;
  const double roughness = 0.01 * limits.clearance + 0.2 * found.distance;
  const double radius = 2.0 * std::max(limits.patch, found.distance);
  if ((found.contact.point - other.contact.point).norm() > radius + 1e-8) return false;
  const Triangle face = shape.triangle(other.contact.face);
  return std::all_of(face.begin(), face.end(), [&](const Vector3d& corner) {
    return found.contact.normal.dot(corner - found.contact.point) >= -roughness - 1e-8;
  });
}

// A plane test would find the nearest face only to within the roughness of a patch.
TEST(Tissue, LooksFindTheNearestFaceAndOnlyFacesNearby) {
  Random random(11);
  for (const ProxyTool& tool : tools(random)) {
    Tissue tissue(tool, PickerKind::kCpu);
    const ProxyOrgan organ = organ_of(bumpy_sphere(random));
    const std::vector<OrganTick> organs = {resting(organ)};
    tissue.set_organs(organs);
    std::size_t looked = 0, touched = 0, covered = 0;
    for (int trial = 0; trial < 60; ++trial) {
      const ToolPose pose = random_hand(tool, random);
      const double distance = random.scale(1e-4, 0.03);
      const PatchFinder::Limits limits{distance, random.scale(1e-4, 0.03),
                                       random.scale(1e-4, 0.01)};
      std::vector<TissueContact> near, all;
      tissue.start_tick();
      EXPECT_TRUE(tissue.look(pose, limits, near));
      tissue.touch({pose}, distance, all);
      ASSERT_EQ(near.empty(), all.empty()) << trial;
      looked += near.size();
      touched += all.size();
      if (all.empty()) continue;
      const auto is_nearer = [](const auto& a, const auto& b) { return a.distance < b.distance; };
      const double nearest = std::min_element(all.begin(), all.end(), is_nearer)->distance;
      EXPECT_TRUE(std::is_sorted(near.begin(), near.end(), is_nearer));
      if (nearest > 0.0) {
        EXPECT_NEAR(near.front().distance, nearest, 1e-8) << trial;
      }
      for (const TissueContact& found : near) {
        EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const TissueContact& other) {
          return other.contact.face == found.contact.face &&
                 other.contact.link == found.contact.link;
        })) << trial;
      }
      if (nearest <= 0.0 || near.size() >= 64) continue;  // Only the nearest faces are told.
      for (const TissueContact& other : all) {
        EXPECT_TRUE(std::any_of(
            near.begin(), near.end(),
            [&](const TissueContact& found) { return covers(found, other, *organ.shape, limits); }))
            << trial << ", a face at " << other.distance << " m";
        ++covered;
      }
    }
    EXPECT_GT(looked, 30u);
    EXPECT_GT(covered, 50u);
    EXPECT_LT(looked, touched);
  }
}

TEST(Tissue, NoPointMovesFartherThanTheFarthestMove) {
  Random random(12);
  for (const ProxyTool& tool : tools(random)) {
    Tissue tissue(tool, PickerKind::kCpu);
    for (int trial = 0; trial < 50; ++trial) {
      const ToolPose from = random_hand(tool, random), to = random_hand(tool, random);
      const double bound = tissue.farthest_move(from, to);
      EXPECT_LE((to.axis.tip - from.axis.tip).norm() * (tool.radius > 0.0 ? 1.0 : 0.0), bound);
      for (std::size_t link = 0; link < tool.links.size(); ++link) {
        const RigidMotion motion(from.links[link], to.links[link]);
        const OrientedBox& box = tool.links[link].parts[0].bounds;
        for (int corner = 0; corner < 8; ++corner) {
          const Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
          const Vector3d point = box.center + box.axes * box.half_size.cwiseProduct(sign);
          double way = 0.0;
          for (int i = 0; i < 32; ++i) {
            way += (motion.at((i + 1) / 32.0) * point - motion.at(i / 32.0) * point).norm();
          }
          EXPECT_LE(way, bound * (1.0 + 1e-12));
        }
      }
    }
  }
}

TEST(ProxyMotion, StaysWhereItIsFreeWhenTheTestsOfATickAreUsedUp) {
  constexpr double kClearance = 2e-3, kRadius = 0.05;
  const ProxyTool tool = ball_tool();
  Tissue tissue(tool, PickerKind::kCpu);
  const auto mobility = make_mobility(tool);
  ProxyMotion motion(*mobility, tissue);
  motion.set_clearance({kClearance});
  const ProxyOrgan organ = organ_of(sphere(60, 90, kRadius));
  const std::vector<OrganTick> organs = {resting(organ)};
  tissue.set_organs(organs);
  const double height = kRadius + kToolRadius + kClearance;
  const ToolPose start = ball_hand({0.0, 0.0, height}), hand = ball_hand({0.02, 0.01, 0.03});
  mobility->measure(hand);
  for (const std::size_t tests : {std::size_t{0}, std::size_t{1}, std::size_t{10}}) {
    tissue.start_tick(tests);
    ProxyPlace place{start, kClearance};
    motion.slide(place, hand, 1e-3);
    EXPECT_EQ(place.pose.axis.tip, start.axis.tip) << tests;
    EXPECT_EQ(place.clearance, kClearance) << tests;
    EXPECT_LE(tissue.tests_made(), tests);
  }
  tissue.start_tick();
  ProxyPlace place{start, kClearance};
  motion.slide(place, hand, 1e-3);
  EXPECT_GT((place.pose.axis.tip - start.axis.tip).norm(), 1e-3);
  EXPECT_FALSE(tissue.is_used_up());
}

}  // namespace
}  // namespace organ_collision
