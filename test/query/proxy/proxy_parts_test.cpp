#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "proxy_scenes.hpp"
#include "query/proxy/least_constraint.hpp"
#include "query/proxy/mobility.hpp"
#include "query/proxy/tissue.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {
namespace {

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

/// The nearest point in the half-spaces: tries all sets of up to `most` active walls.
Displacement nearest_by_trial(const Displacement& goal, const std::vector<Wall>& walls, int most) {
  Displacement best = Displacement::Zero();  // It is legal.
  const std::size_t count = walls.size();
  for (std::size_t set = 0; set < (std::size_t{1} << count); ++set) {
    std::vector<std::size_t> active;
    for (std::size_t i = 0; i < count; ++i) {
      if (set >> i & 1) active.push_back(i);
    }
    if (active.size() > static_cast<std::size_t>(most)) continue;
    Eigen::MatrixXd rows(6, active.size());
    Eigen::VectorXd excess(active.size());
    for (std::size_t i = 0; i < active.size(); ++i) {
      rows.col(i) = walls[active[i]].row;
      excess[i] = walls[active[i]].row.dot(goal) - walls[active[i]].bound;
    }
    Displacement point = goal;
    if (!active.empty()) {
      point -= rows * (rows.transpose() * rows).completeOrthogonalDecomposition().solve(excess);
    }
    const bool is_legal = std::all_of(walls.begin(), walls.end(), [&](const Wall& wall) {
      return wall.row.dot(point) <= wall.bound + 1e-10;
    });
    if (is_legal && (point - goal).norm() < (best - goal).norm()) best = point;
  }
  return best;
}

TEST(LeastConstraint, GoesToTheGoalWhereNoWallHoldsIt) {
  Random random(1);
  LeastConstraint solver;
  const Displacement goal = random_displacement(random, 0.01, 6);
  solver.solve(goal, {});
  EXPECT_EQ(solver.displacement(), goal);
  EXPECT_FALSE(solver.is_held());
  solver.solve(goal, {{goal, 2.0 * goal.squaredNorm()}});
  EXPECT_EQ(solver.displacement(), goal);
  EXPECT_EQ(solver.load(0), 0.0);
}

TEST(LeastConstraint, FindsTheNearestPointInThreeDimensions) {
  Random random(2);
  LeastConstraint solver;
  for (int trial = 0; trial < 2000; ++trial) {
    const Displacement goal = random_displacement(random, 0.02, 3);
    std::vector<Wall> walls = random_walls(random, random.integer(1, 8), 3);
    solver.solve(goal, walls);
    EXPECT_LT(solver.violation(), 1e-3 * goal.norm());
    // It is exactly the nearest point for walls that have moved by the violation.
    for (Wall& wall : walls) wall.bound += solver.violation();
    const Displacement expected = nearest_by_trial(goal, walls, 3);
    EXPECT_LT((solver.displacement() - expected).norm(), 1e-8) << "trial " << trial;
  }
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

TEST(LeastConstraint, DoesNotDependOnTheOrderOfWalls) {
  Random random(6);
  LeastConstraint solver;
  for (int trial = 0; trial < 500; ++trial) {
    const Displacement goal = random_displacement(random, 0.02, 6);
    std::vector<Wall> walls = random_walls(random, 30, 6);
    solver.solve(goal, walls);
    const Displacement first = solver.displacement();
    std::reverse(walls.begin(), walls.end());
    solver.solve(goal, walls);
    EXPECT_LT((solver.displacement() - first).norm(), 1e-9) << "trial " << trial;
  }
}

using Eigen::Isometry3d;
using Eigen::Vector3d;

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

TEST(Mobility, MovesByTheMotionBetween) {
  Random random(1);
  for (const ProxyTool& tool : tools(random)) {
    const auto mobility = make_mobility(tool);
    for (int trial = 0; trial < 200; ++trial) {
      const ToolPose hand = random_hand(tool, random);
      mobility->measure(hand);
      const ToolPose from = mobility->moved(hand, random_displacement(tool, random, 0.02), hand);
      const Displacement by = random_displacement(tool, random, 0.02);
      const ToolPose to = mobility->moved(from, by, hand);
      // A shaft's rotation about itself is no motion.
      const Displacement between = mobility->between(from, to);
      EXPECT_LE(between.norm(), by.norm() + 1e-12);
      EXPECT_LT(difference(mobility->moved(from, between, hand), to), 1e-12);
      // And back to the hand.
      const ToolPose back = mobility->moved(to, mobility->between(to, hand), hand);
      EXPECT_LT(difference(back, hand), 1e-12);
    }
  }
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

/// The row of a contact is the derivative of the place of the tool's point along the normal.
TEST(Mobility, RowsAreDerivatives) {
  Random random(3);
  for (const ProxyTool& tool : tools(random)) {
    const auto mobility = make_mobility(tool);
    for (int trial = 0; trial < 100; ++trial) {
      const ToolPose hand = random_hand(tool, random);
      mobility->measure(hand);
      const ToolPose pose = mobility->moved(hand, random_displacement(tool, random, 0.005), hand);
      FaceContact contact;
      contact.normal = random.direction();
      const bool has_shaft = tool.radius > 0.0;
      const std::size_t parts = tool.links.size() + (has_shaft ? 1 : 0);
      contact.link = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(parts) - 1));
      const bool on_shaft = has_shaft && contact.link == 0;
      const std::size_t link = on_shaft ? 0 : contact.link - (has_shaft ? 1 : 0);
      contact.shaft = on_shaft ? random.uniform(0.0, 1.0) : 0.0;
      const Vector3d in_link = random.point(0.02);
      const auto place = [&](const ToolPose& at) {
        return on_shaft ? at.axis.at(contact.shaft) : Vector3d(at.links[link] * in_link);
      };
      contact.point = place(pose);
      const Displacement row = mobility->row(pose, contact);
      const Displacement by = random_displacement(tool, random, 1e-6);
      const Vector3d moved =
          place(mobility->moved(pose, by, hand)) - place(mobility->moved(pose, -by, hand));
      // The links of a tool through a trocar also turn a little about the shaft (holonomy).
      const bool is_rough = tool.freedom == ProxyFreedom::kTrocar && !on_shaft;
      EXPECT_NEAR(contact.normal.dot(moved), 2.0 * row.dot(by), is_rough ? 0.05 * by.norm() : 2e-10)
          << (on_shaft ? "shaft" : "link") << ", trial " << trial;
    }
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

TEST(Mobility, ABallHasNoDirection) {
  const ProxyTool ball = shaft(ProxyFreedom::kFree);
  const auto mobility = make_mobility(ball);
  const ToolPose hand{{{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}}, {}, {}};
  mobility->measure(hand);
  Displacement by = Displacement::Zero();
  by << 0.01, -0.02, 0.03, 0.0, 0.0, 0.0;
  const ToolPose moved = mobility->moved(hand, by, hand);
  EXPECT_LT((moved.axis.tip - Vector3d(0.11, 0.18, 0.33)).norm(), 1e-15);
  EXPECT_LT((mobility->between(moved, hand) + by).norm(), 1e-15);
  EXPECT_GT(mobility->size(), 0.0);
}

TEST(Mobility, InterpolatesLikeAPath) {
  Random random(5);
  const ProxyTool tool = tool_of_links(random, 0.004, ProxyFreedom::kFree);
  const ToolPose from = random_hand(tool, random), to = random_hand(tool, random);
  EXPECT_LT(difference(interpolate(from, to, 0.0), from), 1e-12);
  EXPECT_LT(difference(interpolate(from, to, 1.0), to), 1e-12);
  const ToolPose middle = interpolate(from, to, 0.5);
  EXPECT_LT((middle.axis.tip - 0.5 * (from.axis.tip + to.axis.tip)).norm(), 1e-12);
  EXPECT_LT((middle.links[1].translation() -
             0.5 * (from.links[1].translation() + to.links[1].translation()))
                .norm(),
            1e-12);
}

TEST(OrganPieces, EachPieceBeginsWhereTheLastOneEnded) {
  const Shape before = shape_of(grid_surface(5, 0.0)), now = shape_of(grid_surface(5, 1.0));
  OrganTick organ = moving(before, now);
  organ.T_now = translation(0.01, 0.02, 0.03);
  constexpr int kPieces = 4;
  const OrganPieces pieces({organ}, kPieces);
  const TriangleMesh* shape = before.get();
  Eigen::Isometry3d frame = organ.T_before;
  for (int i = 0; i < kPieces; ++i) {
    const std::vector<OrganTick> piece = pieces.piece(i);
    ASSERT_EQ(piece.size(), 1u);
    EXPECT_EQ(piece[0].before, shape);
    EXPECT_TRUE(piece[0].T_before.isApprox(frame));
    EXPECT_TRUE(piece[0].is_moving());
    const double end = (i + 1.0) / kPieces;
    for (std::size_t k = 0; k < now->vertices().size(); ++k) {
      const float from = before->vertices()[k], to = now->vertices()[k];
      EXPECT_NEAR(piece[0].now->vertices()[k], from + end * (to - from), 1e-8);
    }
    EXPECT_NEAR(piece[0].T_now.translation().z(), 0.03 * end, 1e-12);
    shape = piece[0].now;
    frame = piece[0].T_now;
  }
  EXPECT_EQ(shape, now.get());
  EXPECT_TRUE(frame.isApprox(organ.T_now));
}

TEST(OrganPieces, ARestingOrganKeepsItsShape) {
  const Shape shape = sheet(0.0);
  const OrganPieces pieces({resting(shape)}, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(pieces.piece(i)[0].now, shape.get());
    EXPECT_FALSE(pieces.piece(i)[0].is_moving());
  }
}

TEST(OrganPieces, ANewOrganHasNoShapeToMoveFrom) {
  const Shape shape = sheet(0.0);
  OrganTick organ = resting(shape);
  organ.before = nullptr;
  const OrganPieces pieces({organ}, 2);
  EXPECT_EQ(pieces.piece(0)[0].now, shape.get());
  EXPECT_FALSE(pieces.piece(0)[0].is_moving());
}

constexpr double kRadius = 0.003;

class TissueTest : public testing::Test {
 protected:
  ProxyTool tool_{kRadius, {}, ProxyFreedom::kTrocar};
  Tissue tissue_{tool_, PickerKind::kFeedback};
  std::vector<TissueContact> contacts_;
};

TEST_F(TissueTest, DistancesAreThoseOfTheToolWithoutItsGrowth) {
  const Shape floor = sheet(0.0);
  const std::vector<OrganTick> organs = {resting(floor)};
  tissue_.set_organs(organs);
  const ToolPose pose = shaft_pose({0.013, 0.002, 0.1}, {0.011, 0.001, 0.0035});
  tissue_.touch(pose, 0.0004, contacts_);
  EXPECT_TRUE(contacts_.empty());
  for (const double growth : {0.0006, 0.002, 0.02}) {
    tissue_.touch(pose, growth, contacts_);
    ASSERT_FALSE(contacts_.empty());
    double nearest = 1.0;
    for (const TissueContact& found : contacts_) nearest = std::min(nearest, found.distance);
    EXPECT_NEAR(nearest, 0.0005, 1e-9) << growth;
  }
}

TEST_F(TissueTest, WithTheLeastGrowthAShaftIsItsAxis) {
  const Shape floor = sheet(0.0);
  const std::vector<OrganTick> organs = {resting(floor)};
  tissue_.set_organs(organs);
  const Vector3d trocar(0.013, 0.002, 0.1);
  tissue_.touch(shaft_pose(trocar, {0.011, 0.001, 2e-6}), tissue_.least_growth(), contacts_);
  EXPECT_TRUE(contacts_.empty());
  tissue_.touch(shaft_pose(trocar, {0.011, 0.001, -2e-6}), tissue_.least_growth(), contacts_);
  EXPECT_FALSE(contacts_.empty());
}

/// The same scene in another frame has the same contacts.
TEST_F(TissueTest, ContactsAreInTheProxysFrame) {
  Isometry3d T_organ_proxy(Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -1.0).normalized()));
  T_organ_proxy.translation() = Vector3d(0.03, -0.05, 0.02);
  const GridSurface wavy = grid_surface(9);
  const Shape here = shape_of(wavy), there = shape_of(wavy, T_organ_proxy);
  OrganTick elsewhere = resting(there);
  elsewhere.T_before = elsewhere.T_now = T_organ_proxy;
  const std::vector<OrganTick> organs = {resting(here), elsewhere};
  tissue_.set_organs(organs);
  const std::vector<ToolPose> way = {shaft_pose({0.0, 0.01, 0.1}, {0.03, 0.02, 0.04}),
                                     shaft_pose({0.0, 0.01, 0.1}, {-0.02, 0.01, -0.03}),
                                     shaft_pose({0.0, 0.01, 0.1}, {-0.03, -0.04, -0.03})};
  tissue_.sweep(way, 0.0, contacts_);
  const std::size_t count = contacts_.size() / 2;
  ASSERT_EQ(contacts_.size(), 2 * count);
  ASSERT_GT(count, 5u);
  for (std::size_t i = 0; i < count; ++i) {
    const FaceContact &a = contacts_[i].contact, &b = contacts_[i + count].contact;
    EXPECT_EQ(contacts_[i].organ, 0u);
    EXPECT_EQ(contacts_[i + count].organ, 1u);
    EXPECT_EQ(a.face, b.face);
    EXPECT_LT((a.point - b.point).norm(), 1e-6);
    EXPECT_LT((a.normal - b.normal).norm(), 1e-3);
    EXPECT_NEAR(a.fraction, b.fraction, 1e-5);
  }
}

TEST_F(TissueTest, SweepsOrganAndToolTogether) {
  const Shape low = sheet(0.0), high = sheet(0.05);
  const std::vector<OrganTick> organs = {moving(low, high)};
  tissue_.set_organs(organs);
  const ToolPose from = shaft_pose({0.013, 0.002, 0.2}, {0.011, 0.001, 0.01});
  const ToolPose to = shaft_pose({0.013, 0.002, 0.2}, {0.011, 0.001, 0.06});
  tissue_.sweep_with_organs(from, to, 0.0, contacts_);
  EXPECT_TRUE(contacts_.empty()) << "they move side by side";
  tissue_.sweep_with_organs(from, from, 0.0, contacts_);
  ASSERT_FALSE(contacts_.empty());
  // The tip is 10 mm above the sheet, its radius 3 mm, and the sheet moves by 50 mm.
  for (const TissueContact& found : contacts_) {
    EXPECT_GE(found.contact.fraction, 0.14 - 1e-6);
    EXPECT_LT(found.contact.normal.z(), 0.0);
  }
  EXPECT_NEAR(contacts_.front().distance, -0.043, 1e-6);
}

TEST_F(TissueTest, AMovingFrameSweepsToo) {
  const Shape floor = sheet(0.0);
  OrganTick organ = resting(floor);
  organ.T_now = translation(0.0, 0.0, -0.05);  // The organ's frame rises by 50 mm.
  const std::vector<OrganTick> organs = {organ};
  EXPECT_TRUE(organ.is_moving());
  tissue_.set_organs(organs);
  const ToolPose pose = shaft_pose({0.013, 0.002, 0.2}, {0.011, 0.001, 0.01});
  tissue_.sweep_with_organs(pose, pose, 0.0, contacts_);
  ASSERT_FALSE(contacts_.empty());
  EXPECT_NEAR(contacts_.front().distance, -0.043, 1e-6);
  EXPECT_NEAR(contacts_.front().contact.end_point.z(), 0.05, 1e-6);
}

TEST_F(TissueTest, FindsCrossingsOfAllOrgansInTheirOrderAlongTheAxis) {
  const Shape high = sheet(0.05), low = sheet(0.01), ball = shape_of(sphere(9, 12, 0.03));
  const std::vector<OrganTick> organs = {resting(low), resting(high), resting(ball)};
  tissue_.set_organs(organs);
  std::vector<TissueCrossing> crossings;
  tissue_.cross({{0.001, 0.002, 0.1}, {0.003, 0.001, -0.1}}, crossings);
  ASSERT_EQ(crossings.size(), 4u);
  EXPECT_EQ(crossings[0].organ, 1u);
  EXPECT_EQ(crossings[1].organ, 2u);
  EXPECT_EQ(crossings[2].organ, 0u);
  EXPECT_EQ(crossings[3].organ, 2u);
  EXPECT_NEAR(crossings[0].crossing.point.z(), 0.05, 1e-7);
}

TEST_F(TissueTest, KnowsTheInside) {
  const GridSurface surface = sphere(9, 12, 0.03);
  const Shape ball = shape_of(surface);
  const SurfaceTopology topology(surface.faces, surface.vertices);
  OrganTick organ = resting(ball);
  organ.topology = &topology;
  const std::vector<OrganTick> organs = {organ};
  tissue_.set_organs(organs);
  const auto is_inside = [&](const Vector3d& trocar, const Vector3d& tip) {
    return tissue_.is_inside(shaft_pose(trocar, tip), tip);
  };
  EXPECT_TRUE(is_inside({0.0, 0.0, 0.01}, {0.001, 0.0, -0.01}));
  EXPECT_TRUE(is_inside({0.0, 0.0, 0.1}, {0.001, 0.0, -0.1})) << "it goes through";
  EXPECT_FALSE(is_inside({0.0, 0.0, 0.1}, {0.001, 0.0, 0.05}));
}

}  // namespace

}  // namespace organ_collision
