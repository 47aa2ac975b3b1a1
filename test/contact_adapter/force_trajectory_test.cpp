#include "force_trajectory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "contact_adapter/force_law.hpp"
#include "contact_adapter/penalty_forces.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "test/proof/trials.hpp"

// Forces from real queries, step by step along trajectories against flat surfaces: tissue, a wall,
// a sheet.

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

/// A block with its top in the plane z = 0 (where x > 0) and its wall in the plane x = 0 below it.
TriangleMesh block(double cell) {
  const int across = static_cast<int>(std::lround(0.08 / cell));
  return grid_mesh(across, 2 * across, [](double u, double v) -> Vector3d {
    const double way = 0.08 * u - 0.04;
    return {std::max(way, 0.0), 0.16 * v - 0.0813, std::min(way, 0.0)};
  });
}

}  // namespace

TEST(ForceTrajectory, LyingOnTissueItGrowsOnPastTheRadius) {
  for (const double cell : kCells) {
    const TriangleMesh sheet = folded_sheet(0.0, 0.0, cell);
    for (const double tilt : {0.0, 0.01, -0.01, 0.05}) {
      const auto at = [&](double z) { return lying(0.0013, z, tilt); };
      const auto steps = expect_no_jump("cell " + std::to_string(cell), sheet,
                                        {at(0.007), at(-0.0045), at(0.007)});
      for (const ForceStep& step : steps) {
        const double lowest = std::min(step.axis.tip.z(), step.axis.trocar.z());
        const double depth = std::max(0.0, kRadius - lowest);
        EXPECT_LE(angle_between(step.force, Vector3d::UnitZ()), step.force.z() > 0.1 ? 1e-3 : 4.0);
        // If the trocar's end is inside the tissue, no contact reports its depth.
        if (tilt < 0.0 && step.axis.trocar.z() < 0.0) continue;
        EXPECT_NEAR(step.force.z(), kStiffness * depth, 2.0 * kStiffness * kStep);
      }
    }
  }
}

TEST(ForceTrajectory, SlidingWhileSunkItStays) {
  for (const double cell : kCells) {
    const TriangleMesh sheet = folded_sheet(0.0, 0.0, cell);
    const auto steps = expect_no_jump(
        "cell " + std::to_string(cell), sheet,
        {lying(0.0013, 0.006, 0.0), lying(0.0013, -0.003, 0.0), lying(0.0113, -0.003, 0.0)});
    EXPECT_NEAR(steps.back().force.z(), kStiffness * (kRadius + 0.003), kStiffness * 2 * kStep);
    EXPECT_LE(angle_between(steps.back().force, Vector3d::UnitZ()), 1e-3);
  }
}

TEST(ForceTrajectory, PushedIntoAWallItStaysTheWalls) {
  for (const double cell : kCells) {
    const TriangleMesh organ = block(cell);
    for (const double lean : {0.0, 0.001, -0.001, 0.01}) {
      const auto at = [&](double x) {
        return ShaftAxis{{x - lean, 0.0031, 0.1}, {x, 0.0031, -0.013}};
      };
      const auto steps = expect_no_jump("cell " + std::to_string(cell), organ,
                                        {at(-0.0061), at(0.0045), at(-0.0061)});
      for (const ForceStep& step : steps) {
        EXPECT_LE(step.force.x(), 1e-9);
        EXPECT_LE(step.force.z(), 0.15 * std::abs(step.force.x()) + 1e-9);
      }
    }
  }
}

TEST(ForceTrajectory, TurnedIntoAWallAboutTheTrocarItStaysTheWalls) {
  const auto at = [](double x) { return ShaftAxis{{-0.0061, 0.0031, 0.1}, {x, 0.0031, -0.013}}; };
  for (const double cell : kCells) {
    const auto steps = expect_no_jump("cell " + std::to_string(cell), block(cell),
                                      {at(-0.0061), at(0.0045), at(-0.0061)});
    for (const ForceStep& step : steps) EXPECT_LE(step.force.x(), 1e-9);
  }
}

TEST(ForceTrajectory, ThroughASheetAndBack) {
  for (const double cell : kCells) {
    for (const double lean : {0.0, 0.3, 1.0}) {
      const Vector3d along = Vector3d(lean, 0.1 * lean, -1.0).normalized();
      const Vector3d hole(0.0013, 0.0021, 0.0);
      const auto at = [&](double way) { return ShaftAxis{hole - 0.1 * along, hole + way * along}; };
      const auto steps =
          expect_no_jump("cell " + std::to_string(cell), folded_sheet(0.0, 0.0, cell),
                         {at(-0.015), at(0.03), at(-0.015)});
      for (const ForceStep& step : steps) {
        const double depth = std::max(0.0, kRadius - step.axis.tip.z());
        EXPECT_LE((step.force - kStiffness * depth * Vector3d::UnitZ()).norm(), kStiffness * kStep);
      }
    }
  }
}

TEST(ForceTrajectory, OfAnUnknownRadiusItGrowsOnPastTheFaceToo) {
  const TriangleMesh sheet = folded_sheet(0.0, 0.0, 0.005);
  const auto at = [](double z) { return lying(0.0013, z, 0.0); };
  const auto steps = forces_along(way_through({at(0.006), at(-0.0045), at(0.006)}, kStep), sheet,
                                  remembering_law(std::nullopt));
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_LE(steps[i].change, 2.0 * kStiffness * kStep);
    const double depth = std::max(0.0, kRadius - steps[i].axis.tip.z());
    EXPECT_NEAR(steps[i].force.z(), kStiffness * depth, kStiffness * 2 * kStep);
  }
}

// Forces from real queries, step by step along trajectories into creases and over edges.

using namespace organ_collision;

namespace {

/// A shaft at these distances [m] from the two sides of a crease of 90 degrees.
ShaftAxis in_crease(double from_left, double from_right) {
  return lying(std::sqrt(0.5) * (from_left - from_right), std::sqrt(0.5) * (from_left + from_right),
               0.0);
}

}  // namespace

TEST(ForceTrajectory, BothSidesOfACreaseCountHoweverItIsDivided) {
  for (const double cell : {0.02, 0.01, 0.005, 0.0025, 0.00125, 0.0005}) {
    const auto steps =
        expect_no_jump("cell " + std::to_string(cell), folded_sheet(M_PI / 4, M_PI / 4, cell),
                       {in_crease(0.006, 0.007), in_crease(0.001, 0.0042)});
    const Vector3d left(std::sqrt(0.5), 0.0, std::sqrt(0.5)), right(-left.x(), 0.0, left.z());
    const Vector3d expected = kStiffness * (0.004 * left + 0.0008 * right);
    EXPECT_LE((steps.back().force - expected).norm(), 1e-3) << "cell " << cell;
  }
}

TEST(ForceTrajectory, PastOneSideOfACreaseTheOtherCountsOn) {
  for (const double cell : kCells) {
    const TriangleMesh crease = folded_sheet(M_PI / 4, M_PI / 4, cell);
    expect_no_jump("cell " + std::to_string(cell), crease,
                   {in_crease(0.006, 0.007), in_crease(0.001, 0.0042), in_crease(-0.002, 0.0035),
                    in_crease(-0.002, 0.0042), in_crease(0.006, 0.007)});
    for (const double tilt : {0.0, 0.01, -0.01}) {
      expect_no_jump("to its bottom, cell " + std::to_string(cell), crease,
                     {lying(0.0, 0.009, tilt), lying(0.0, -0.0035, tilt), lying(0.0, 0.009, tilt)});
    }
  }
}

TEST(ForceTrajectory, AnEdgeIsNotSlippedOffPastTheRadius) {
  for (const double cell : kCells) {
    const TriangleMesh edge = folded_sheet(-M_PI / 4, -M_PI / 4, cell);
    for (const double beside : {0.0, 3e-5, 1e-3}) {
      for (const double tilt : {0.0, -0.01, 0.05}) {
        const auto steps = expect_no_jump(
            "cell " + std::to_string(cell), edge,
            {lying(beside, 0.007, tilt), lying(beside, -0.004, tilt), lying(beside, 0.007, tilt)});
        // The force points straight away from the edge until the axis is half a radius from it.
        // From there on, its direction stays.
        const double half = std::sqrt(0.25 * kRadius * kRadius - beside * beside);
        for (const ForceStep& step : steps) {
          const double lowest = std::min(step.axis.tip.z(), step.axis.trocar.z());
          const Vector3d away(beside, 0.0, std::max(half, lowest));
          EXPECT_LE(angle_between(step.force, away), step.force.norm() > 0.5 ? 0.03 : 4.0);
        }
      }
    }
  }
}

TEST(ForceTrajectory, AcrossAnEdgeItPushesUp) {
  for (const double cell : kCells) {
    for (const double yaw : {0.0, 0.2}) {
      const auto at = [&](double z) {
        const Vector3d along(1.0, yaw, -0.013), middle(0.0, 0.003, z);
        return ShaftAxis{middle - 0.1 * along, middle + 0.06 * along};
      };
      const auto steps =
          expect_no_jump("cell " + std::to_string(cell), folded_sheet(-M_PI / 4, -M_PI / 4, cell),
                         {at(0.0061), at(-0.0045), at(0.0061)});
      for (const ForceStep& step : steps) {
        EXPECT_LE(angle_between(step.force, Vector3d::UnitZ()), step.force.norm() > 0.5 ? 0.1 : 4);
      }
    }
  }
}

// Forces from real queries, step by step along trajectories over saddles and hills.

using namespace organ_collision;

namespace {

/// A saddle with the curvatures 1 / radius along the x axis, where it rises, and -1 / radius along
/// the y axis.
TriangleMesh saddle(double radius, double cell) {
  const int cells = static_cast<int>(std::lround(0.06 / cell));
  return grid_mesh(cells, cells, [&](double u, double v) -> Vector3d {
    const double x = 0.06 * u - 0.0297, y = 0.06 * v - 0.0302;
    return {x, y, (x * x - y * y) / (2.0 * radius)};
  });
}

}  // namespace

TEST(ForceTrajectory, OnASaddle) {
  // In some of these cases the tip is in the rising wall of the valley, or the axis is past the
  // saddle.
  for (const double radius : {0.03, 0.012}) {
    for (const double cell : {0.02, 0.005, 0.0025, 0.00125}) {
      const TriangleMesh organ = saddle(radius, cell);
      for (const double yaw : {0.0, 0.7, 1.2, 1.5}) {
        const auto at = [&](double z) {
          const Vector3d along(std::sin(yaw), std::cos(yaw), -0.02), middle(0.0, 0.001, z);
          return ShaftAxis{middle - 0.05 * along, middle + 0.02 * along};
        };
        expect_no_jump("radius " + std::to_string(radius) + ", cell " + std::to_string(cell) +
                           ", yaw " + std::to_string(yaw),
                       organ, {at(0.015), at(-0.003), at(0.015)});
      }
    }
  }
}

TEST(ForceTrajectory, AtRestItComesToThePushes) {
  // At a height of 1.7 mm, the tip moves to another facet, and its depth changes by 1.3 mm.
  const TriangleMesh organ = saddle(0.03, 0.005);
  const auto at = [](double z) {
    const Vector3d along(std::sin(1.5), std::cos(1.5), -0.02), middle(0.0, 0.001, z);
    return ShaftAxis{middle - 0.05 * along, middle + 0.02 * along};
  };
  std::vector<ShaftAxis> poses = way_through({at(0.015), at(0.0017)}, kStep);
  const std::size_t stop = poses.size() - 1;
  poses.insert(poses.end(), 30, poses.back());
  KeptSides sides;
  std::vector<double> lags;
  ForceLaw law;
  const auto steps = forces_along(poses, organ, [&](const ContactArray& answer) {
    const Vector3d now =
        to_eigen(wrench_of(law.follow(answer, kSeconds, kStiffness, kRadius)).force);
    Vector3d goal = Vector3d::Zero();
    for (const Vector3d& force : penalty_forces(sides.follow(answer, kRadius), kStiffness)) {
      goal += force;
    }
    lags.push_back((now - goal).norm());
    return now;
  });
  EXPECT_GT(lags[stop], 0.5);
  EXPECT_LE(lags.back(), 1e-9);
  for (std::size_t i = stop + 3; i < steps.size(); ++i) EXPECT_LE(steps[i].change, 0.0501);
}

TEST(ForceTrajectory, OverHillsOnRandomWays) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 60; ++i) {
    const double height = 0.004 * (1.0 + number(random)), shift = number(random);
    const TriangleMesh hills = grid_mesh(12, 12, [&](double u, double v) -> Vector3d {
      const double x = 0.06 * u - 0.0297, y = 0.06 * v - 0.0302;
      return {x, y, height * std::sin(200.0 * x + shift) * std::cos(170.0 * y)};
    });
    const double yaw = 3.0 * number(random);
    const Vector3d along(std::sin(yaw), std::cos(yaw), 0.1 * number(random));
    Vector3d middle(0.005 * number(random), 0.005 * number(random), 0.022);
    std::vector<ShaftAxis> corners;
    for (const double highest : {0.022, 0.004, 0.004, 0.004, 0.022}) {
      const double lean = 0.003 * number(random);
      corners.push_back({middle - 0.05 * along + Vector3d(lean, 0.0, 0.01), middle + 0.02 * along});
      middle = {middle.x() + 0.004 * number(random), middle.y() + 0.004 * number(random),
                highest - 0.003 * (1.0 + number(random))};
    }
    expect_no_jump("way " + std::to_string(i), hills, corners);
  }
}

// Forces from real queries, step by step along trajectories into closed organs and out again.

using namespace organ_collision;
using Eigen::Isometry3d;

namespace {

constexpr double kStep = 1e-4;         // [m]
constexpr double kSeconds = 1e-3;      // [s]
constexpr double kStiffness = 1000.0;  // [N/m]
constexpr double kRadius = 0.005;      // [m]

struct InsideStep {
  Isometry3d pose;
  Vector3d force;
  bool is_touching;
  bool is_inside;   ///< nothing is touched, and the tip is inside
  double distance;  ///< [m] of the clearance
};

Isometry3d pose_at(const Vector3d& place, const Vector3d& rotation = Vector3d::Zero()) {
  Isometry3d pose = Isometry3d::Identity();
  if (!rotation.isZero(0.0)) {
    pose.linear() = Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
  }
  pose.translation() = place;
  return pose;
}

/// Interpolates poses, so that no point of the tool moves by more than about kStep.
std::vector<Isometry3d> way_through(const std::vector<Isometry3d>& corners) {
  std::vector<Isometry3d> poses = {corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Isometry3d &from = corners[i - 1], &to = corners[i];
    const int count = static_cast<int>(std::ceil(PlacedTool::way(from, to) / kStep));
    const Eigen::Quaterniond start(from.linear()), end(to.linear());
    for (int k = 1; k <= count; ++k) {
      const double share = static_cast<double>(k) / count;
      Isometry3d pose = Isometry3d::Identity();
      pose.linear() = start.slerp(share, end).toRotationMatrix();
      pose.translation() = from.translation() + share * (to.translation() - from.translation());
      poses.push_back(pose);
    }
  }
  return poses;
}

/// Moves the tool along the poses. Expects that no change of the force exceeds the limit.
std::vector<InsideStep> expect_limited(const std::string& what, const PlacedTool& tool,
                                       const std::vector<Isometry3d>& poses,
                                       const TriangleMesh& organ) {
  const SurfaceTopology topology(organ.faces(), organ.vertices());
  CollisionQuery query;
  ForceLaw law;
  KeptSides::Radius radius;
  if (tool.radius > 0.0) radius = tool.radius;
  std::vector<InsideStep> steps;
  for (const Isometry3d& pose : poses) {
    const auto from = steps.empty() ? std::optional<Isometry3d>() : steps.back().pose;
    const ContactArray answer = answer_of(tool, from, pose, organ, topology, query);
    const auto wrench = wrench_of(law.follow(answer, kSeconds, kStiffness, radius));
    InsideStep step{pose, to_eigen(wrench.force), !answer.contacts.empty(),
                    answer.contacts.empty() && answer.placement.tip == ToolPlacement::INSIDE,
                    answer.clearance.distance};
    // When the tool leaves the last face, there is no force at once.
    if (!steps.empty() && (step.is_touching || step.is_inside)) {
      const double change = (step.force - steps.back().force).norm();
      const double way = PlacedTool::way(*from, pose);
      EXPECT_LE(change, kStiffness * (4.0 * way + 0.05 * kSeconds) * (1.0 + 1e-6))
          << what << ", step " << steps.size() << " at " << pose.translation().transpose()
          << ": force " << step.force.transpose() << " after " << steps.back().force.transpose()
          << ", " << answer.contacts.size() << " contacts";
    }
    steps.push_back(step);
  }
  return steps;
}

PlacedTool shaft(double length) {
  PlacedTool tool;
  tool.axis = {{0.0, -0.5 * length, 0.0}, {0.0, 0.5 * length, 0.0}};
  tool.radius = kRadius;
  tool.tip = tool.axis.tip;
  return tool;
}

PlacedTool link_of(const LinkPart& part) {
  PlacedTool tool;
  tool.links = {Link{"jaw", {part}}};
  return tool;
}

const Vector3d kBoxSize(0.013, 0.021, 0.009);  // [m]
PlacedTool sphere() { return link_of(LinkPart::sphere(Vector3d::Zero(), kRadius)); }
PlacedTool box() { return link_of(LinkPart::box(Isometry3d::Identity(), kBoxSize)); }

}  // namespace

TEST(ForceInside, OfASunkShaftItGrowsOnAlongTheNearestWayOut) {
  for (const int cells : {4, 11}) {
    for (const double tilt : {0.0, 0.05, -0.11}) {
      const auto at = [&](double z) { return pose_at({0.0031, 0.0017, z}, {tilt, 0.0, 0.0}); };
      const auto steps =
          expect_limited("tilt " + std::to_string(tilt), shaft(0.05),
                         way_through({at(0.012), at(-0.019), at(0.012)}), closed_block(cells));
      int inside = 0;
      for (const InsideStep& step : steps) {
        const double highest = step.pose.translation().z() + 0.025 * std::abs(std::sin(tilt));
        // While the contacts end, the force of a tilted shaft goes from its deeper end, which they
        // report, to the way out of its higher end.
        if (!step.is_inside || (tilt != 0.0 && step.distance < 0.003)) continue;
        ++inside;
        const Vector3d expected(0.0, 0.0, kStiffness * (kRadius - highest));
        EXPECT_LE((step.force - expected).norm(), 2.0 * kStiffness * kStep);
      }
      EXPECT_GT(inside, 50);
      EXPECT_TRUE(steps.back().force.isZero(0.0));
    }
  }
}

TEST(ForceInside, OfASunkLinkItGrowsOnAlongTheNearestWayOut) {
  const TriangleMesh block = closed_block(7);
  for (const bool is_box : {false, true}) {
    const double half = is_box ? 0.5 * kBoxSize.z() : kRadius;
    const auto at = [](double z) { return pose_at({0.0031, 0.0017, z}); };
    const auto steps = expect_limited(is_box ? "box" : "sphere", is_box ? box() : sphere(),
                                      way_through({at(0.012), at(-0.019), at(0.012)}), block);
    int inside = 0;
    for (const InsideStep& step : steps) {
      const double depth = std::max(0.0, half - step.pose.translation().z());
      EXPECT_LE((step.force - Vector3d(0.0, 0.0, kStiffness * depth)).norm(),
                4.0 * kStiffness * kStep)
          << is_box << " at " << step.pose.translation().z();
      if (step.is_inside) ++inside;
    }
    EXPECT_GT(inside, 100);
    EXPECT_TRUE(steps.back().force.isZero(0.0));
  }
}

TEST(ForceInside, OfATipThatIsPushedInDeepAndDrawnOut) {
  // The trocar stays outside. The surface that the tip pierced pushes all the time.
  for (const double lean : {0.0, 0.4}) {
    const Vector3d along = Vector3d(lean, 0.2 * lean, -1.0).normalized();
    PlacedTool tool;
    tool.axis = {-0.04 * along, 0.04 * along};
    tool.radius = kRadius;
    tool.tip = tool.axis.tip;
    const auto at = [&](double way) {
      return pose_at(Vector3d(0.0031, 0.0017, 0.0) + way * along);
    };
    const auto steps =
        expect_limited("lean " + std::to_string(lean), tool,
                       way_through({at(-0.06), at(-0.008), at(-0.06)}), closed_block(7));
    for (const InsideStep& step : steps) {
      const double depth = std::max(0.0, kRadius - (step.pose * tool.tip).z());
      EXPECT_LE((step.force - kStiffness * depth * Vector3d::UnitZ()).norm(), kStiffness * kStep);
    }
  }
}

TEST(ForceInside, OfAShaftThatIsPushedInWholly) {
  // Tip first, beyond its trocar. Then the nearest way out is another one than that of the tip.
  const auto at = [](double z) { return pose_at({0.0031, 0.0017, z}, {-0.45 * M_PI, 0.0, 0.0}); };
  auto poses = way_through({at(0.04), at(-0.029)});
  const std::size_t deepest = poses.size();
  poses.insert(poses.end(), 2000, poses.back());
  for (const Isometry3d& pose : way_through({at(-0.029), at(0.04)})) poses.push_back(pose);
  const auto steps = expect_limited("axial", shaft(0.03), poses, closed_block(7));
  const InsideStep& rested = steps[deepest + 1999];
  EXPECT_TRUE(rested.is_inside);
  EXPECT_NEAR(rested.force.norm(), kStiffness * (2.0 * kRadius + rested.distance), 1e-6);
  EXPECT_TRUE(steps.back().force.isZero(0.0));
}

TEST(ForceInside, OnRandomWaysItDoesNotJump) {
  oracle::Random random(17);
  const PlacedTool tools[] = {shaft(0.03), sphere(), box()};
  const TriangleMesh organs[] = {closed_block(5), closed_ellipsoid(6)};
  int inside = 0;
  for (int i = 0; i < 18; ++i) {
    const auto random_pose = [&](double z) {
      return pose_at({random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), z},
                     random.point(0.9));
    };
    const auto poses = way_through({random_pose(0.04), random_pose(random.uniform(-0.02, 0.0)),
                                    random_pose(random.uniform(-0.05, -0.01)), random_pose(0.04)});
    const auto steps = expect_limited("way " + std::to_string(i), tools[i % 3], poses,
                                      organs[random.integer(0, 1)]);
    for (const InsideStep& step : steps) inside += step.is_inside ? 1 : 0;
    EXPECT_TRUE(steps.back().force.isZero(0.0)) << i;
  }
  EXPECT_GT(inside, 1000);
}
