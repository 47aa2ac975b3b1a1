#include "query/proxy/least_constraint.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

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

}  // namespace
}  // namespace organ_collision
