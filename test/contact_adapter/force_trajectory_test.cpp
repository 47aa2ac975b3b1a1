// Forces from real queries, step by step along trajectories: against flat surfaces, into creases,
// over edges, saddles and hills, and into closed organs and out again.

#include "force_trajectory.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "contact_adapter/force_law.hpp"
#include "test/closed_surfaces.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kStep = 1e-4;                       // [m] distance between poses of a trajectory
constexpr double kSeconds = 1e-3;                    // [s] duration of a step
constexpr double kCells[] = {0.02, 0.005, 0.00125};  // [m] sizes of the organ's grid cells

/// The pose at a time in [0, 1] of the motion between two poses.
ToolWaypoint between(const ToolWaypoint& from, const ToolWaypoint& to, double time) {
  ToolWaypoint pose{0.0, ShaftMotion{from.axis, to.axis}.at(time)};
  for (std::size_t i = 0; i < from.links.size(); ++i) {
    pose.links.push_back(oracle::between(from.links[i], to.links[i], time));
  }
  return pose;
}

/// [m] The largest distance that an end of the axis moves, or a point of a link within 40 mm of its
/// frame.
double way_between(const ToolWaypoint& from, const ToolWaypoint& to) {
  double most =
      std::max((to.axis.trocar - from.axis.trocar).norm(), (to.axis.tip - from.axis.tip).norm());
  for (std::size_t i = 0; i < 8 * from.links.size(); ++i) {
    const Vector3d p(i & 1 ? 0.04 : -0.04, i & 2 ? 0.04 : -0.04, i & 4 ? 0.04 : -0.04);
    most = std::max(most, (to.links[i / 8] * p - from.links[i / 8] * p).norm());
  }
  return most;
}

/// The forces on a tool that moves in steps of about kStep through `corners`, and rests for
/// `resting_steps` at each. Expects that no change of the force exceeds the limit. A tool for which
/// clearance and placement are asked has no force at once when it leaves the last face.
std::vector<ForceStep> expect_limited(const std::string& what, const CollisionRequest& request,
                                      const std::vector<ToolWaypoint>& corners,
                                      const ShaftRadius& radius, int resting_steps = 0) {
  std::vector<ToolWaypoint> poses = {corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const int count = static_cast<int>(std::ceil(way_between(corners[i - 1], corners[i]) / kStep));
    for (int k = 1; k <= count; ++k) {
      poses.push_back(between(corners[i - 1], corners[i], static_cast<double>(k) / count));
    }
    poses.insert(poses.end(), resting_steps, corners[i]);
  }
  ForceLaw law;
  const auto steps = forces_along(poses, request, [&](const ContactArray& answer) -> Vector3d {
    return sum_of(law.follow(answer, kSeconds, kStiffness, radius));
  });
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const ForceStep &last = steps[i - 1], &step = steps[i];
    if (request.clearance && step.contacts == 0 && !step.is_inside) continue;
    const double way = way_between(last.pose, step.pose);
    const double most =
        request.clearance ? (1.0 + 1e-6) * (4.0 * way + 0.05 * kSeconds) : 5.0 * way;
    EXPECT_LE((step.force - last.force).norm(), kStiffness * most)
        << what << ", step " << i << ", tip at " << step.pose.axis.tip.transpose() << ": force "
        << step.force.transpose() << " after " << last.force.transpose() << ", " << step.contacts
        << " contacts";
  }
  if (request.clearance) {
    EXPECT_TRUE(steps.back().force.isZero(0.0)) << what;
  }
  return steps;
}

/// The forces on a shaft that moves through `corners`.
std::vector<ForceStep> expect_no_jump(const std::string& what, const TriangleMesh& organ,
                                      const std::vector<ToolWaypoint>& corners,
                                      const ShaftRadius& radius = kRadius) {
  CollisionRequest request;
  request.organ = &organ;
  request.radius = kRadius;
  return expect_limited(what, request, corners, radius);
}

/// A shaft parallel to the y axis through (x, 0.003, z), except that its tip is lowered by `tilt`
/// [rad].
ToolWaypoint lying(double x, double z, double tilt) {
  const Vector3d middle(x, 0.003, z), along(0.0, 1.0, -tilt);
  return {0.0, {middle - 0.05 * along, middle + 0.04 * along}};
}

double lowest_end(const ForceStep& step) {
  return std::min(step.pose.axis.tip.z(), step.pose.axis.trocar.z());
}

/// The angle between two vectors [rad].
double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Once for each size of the organ's cells.
class ForceTrajectoryTest : public testing::TestWithParam<double> {
 protected:
  const double cell_ = GetParam();
};

TEST_P(ForceTrajectoryTest, LyingOnTissueItGrowsOnPastTheRadius) {
  const TriangleMesh sheet = folded_sheet(0.0, 0.0, cell_);
  for (const double tilt : {0.0, 0.01, -0.01, 0.05}) {
    const auto at = [&](double z) { return lying(0.0013, z, tilt); };
    for (const ForceStep& step :
         expect_no_jump("sheet", sheet, {at(0.007), at(-0.0045), at(0.007)})) {
      const double depth = std::max(0.0, kRadius - lowest_end(step));
      EXPECT_LE(angle_between(step.force, Vector3d::UnitZ()), step.force.z() > 0.1 ? 1e-3 : 4.0);
      // If the trocar's end is inside the tissue, no contact reports its depth.
      if (tilt < 0.0 && step.pose.axis.trocar.z() < 0.0) continue;
      EXPECT_NEAR(step.force.z(), kStiffness * depth, 2.0 * kStiffness * kStep);
    }
  }
  const auto slid = expect_no_jump(
      "sliding", sheet,
      {lying(0.0013, 0.006, 0.0), lying(0.0013, -0.003, 0.0), lying(0.0113, -0.003, 0.0)});
  EXPECT_NEAR(slid.back().force.z(), kStiffness * (kRadius + 0.003), kStiffness * 2 * kStep);
}

TEST_P(ForceTrajectoryTest, PushedIntoAWallItStaysTheWalls) {
  // A block with its top in the plane z = 0, where x > 0, and its wall in x = 0 below it.
  const int across = static_cast<int>(std::lround(0.08 / cell_));
  const TriangleMesh block = grid_mesh(across, 2 * across, [](double u, double v) -> Vector3d {
    const double way = 0.08 * u - 0.04;
    return {std::max(way, 0.0), 0.16 * v - 0.0813, std::min(way, 0.0)};
  });
  for (const double lean : {0.0, 0.001, -0.001, 0.01}) {
    const auto at = [&](double x) {
      return ToolWaypoint{0.0, {{x - lean, 0.0031, 0.1}, {x, 0.0031, -0.013}}};
    };
    for (const ForceStep& step :
         expect_no_jump("wall", block, {at(-0.0061), at(0.0045), at(-0.0061)})) {
      EXPECT_LE(step.force.x(), 1e-9);
      EXPECT_LE(step.force.z(), 0.15 * std::abs(step.force.x()) + 1e-9);
    }
  }
}

TEST_P(ForceTrajectoryTest, ThroughASheetAndBack) {
  for (const double lean : {0.0, 0.3, 1.0}) {
    const Vector3d along = Vector3d(lean, 0.1 * lean, -1.0).normalized();
    const Vector3d hole(0.0013, 0.0021, 0.0);
    const auto at = [&](double way) {
      return ToolWaypoint{0.0, {hole - 0.1 * along, hole + way * along}};
    };
    for (const ForceStep& step : expect_no_jump("stab", folded_sheet(0.0, 0.0, cell_),
                                                {at(-0.015), at(0.03), at(-0.015)})) {
      const double depth = std::max(0.0, kRadius - step.pose.axis.tip.z());
      EXPECT_LE((step.force - kStiffness * depth * Vector3d::UnitZ()).norm(), kStiffness * kStep);
    }
  }
}

TEST_P(ForceTrajectoryTest, OfAnUnknownRadiusItGrowsOnPastTheFaceToo) {
  const auto at = [](double z) { return lying(0.0013, z, 0.0); };
  for (const ForceStep& step : expect_no_jump("unknown radius", folded_sheet(0.0, 0.0, cell_),
                                              {at(0.006), at(-0.0045), at(0.006)}, std::nullopt)) {
    const double depth = std::max(0.0, kRadius - step.pose.axis.tip.z());
    EXPECT_NEAR(step.force.z(), kStiffness * depth, kStiffness * 2 * kStep);
  }
}

TEST_P(ForceTrajectoryTest, BothSidesOfACreaseCountAndGoOnPastEach) {
  const double half = std::sqrt(0.5);
  // At these distances [m] from the two sides.
  const auto at = [&](double from_left, double from_right) {
    return lying(half * (from_left - from_right), half * (from_left + from_right), 0.0);
  };
  const TriangleMesh crease = folded_sheet(M_PI / 4, M_PI / 4, cell_);
  const auto steps = expect_no_jump("crease", crease, {at(0.006, 0.007), at(0.001, 0.0042)});
  const Vector3d left(half, 0.0, half), right(-half, 0.0, half);
  EXPECT_LE((steps.back().force - kStiffness * (0.004 * left + 0.0008 * right)).norm(), 1e-3);
  expect_no_jump("past one side", crease,
                 {at(0.006, 0.007), at(0.001, 0.0042), at(-0.002, 0.0035), at(-0.002, 0.0042),
                  at(0.006, 0.007)});
  for (const double tilt : {0.0, 0.01, -0.01}) {
    expect_no_jump("to its bottom", crease,
                   {lying(0.0, 0.009, tilt), lying(0.0, -0.0035, tilt), lying(0.0, 0.009, tilt)});
  }
}

TEST_P(ForceTrajectoryTest, AnEdgeIsNotSlippedOffPastTheRadius) {
  const TriangleMesh edge = folded_sheet(-M_PI / 4, -M_PI / 4, cell_);
  for (const double beside : {0.0, 3e-5, 1e-3}) {
    for (const double tilt : {0.0, -0.01, 0.05}) {
      const auto at = [&](double z) { return lying(beside, z, tilt); };
      // The force points straight away from the edge until the axis is half a radius from it.
      // From there on, its direction stays.
      const double half = std::sqrt(0.25 * kRadius * kRadius - beside * beside);
      for (const ForceStep& step :
           expect_no_jump("edge", edge, {at(0.007), at(-0.004), at(0.007)})) {
        const Vector3d away(beside, 0.0, std::max(half, lowest_end(step)));
        EXPECT_LE(angle_between(step.force, away), step.force.norm() > 0.5 ? 0.03 : 4.0);
      }
    }
  }
  for (const double yaw : {0.0, 0.2}) {
    const auto at = [&](double z) {
      const Vector3d along(1.0, yaw, -0.013), middle(0.0, 0.003, z);
      return ToolWaypoint{0.0, {middle - 0.1 * along, middle + 0.06 * along}};
    };
    for (const ForceStep& step :
         expect_no_jump("across the edge", edge, {at(0.0061), at(-0.0045), at(0.0061)})) {
      EXPECT_LE(angle_between(step.force, Vector3d::UnitZ()), step.force.norm() > 0.5 ? 0.1 : 4);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cells, ForceTrajectoryTest, testing::ValuesIn(kCells));

TEST(ForceTrajectory, OverHillsOnRandomWays) {
  oracle::Random random(3);
  for (int i = 0; i < 60; ++i) {
    const double height = random.uniform(0.0, 0.008), shift = random.uniform(-1.0, 1.0);
    const TriangleMesh hills = grid_mesh(12, 12, [&](double u, double v) -> Vector3d {
      const double x = 0.06 * u - 0.0297, y = 0.06 * v - 0.0302;
      return {x, y, height * std::sin(200.0 * x + shift) * std::cos(170.0 * y)};
    });
    const double yaw = random.uniform(-3.0, 3.0);
    const Vector3d along(std::sin(yaw), std::cos(yaw), random.uniform(-0.1, 0.1));
    Vector3d middle(random.uniform(-0.005, 0.005), random.uniform(-0.005, 0.005), 0.022);
    std::vector<ToolWaypoint> corners;
    for (const double highest : {0.022, 0.004, 0.004, 0.004, 0.022}) {
      const Vector3d lean(random.uniform(-0.003, 0.003), 0.0, 0.01);
      corners.push_back({0.0, {middle - 0.05 * along + lean, middle + 0.02 * along}});
      middle = {middle.x() + random.uniform(-0.004, 0.004),
                middle.y() + random.uniform(-0.004, 0.004), highest - random.uniform(0.0, 0.006)};
    }
    expect_no_jump("way " + std::to_string(i), hills, corners);
  }
}

/// A rigid tool: a shaft of kRadius, whose tip is first, or one link.
struct PlacedTool {
  std::string name;
  double length = 0.0;  ///< [m] of the shaft
  std::vector<Link> links = {};

  ToolWaypoint at(const Isometry3d& pose) const {
    const Vector3d tip = 0.5 * length * Vector3d::UnitY();
    ToolWaypoint waypoint{0.0, {pose * -tip, pose * tip}};
    if (!links.empty()) waypoint.links = {pose};
    return waypoint;
  }
};

const Vector3d kBoxSize(0.013, 0.021, 0.009);  // [m]

PlacedTool shaft(double length) { return {"shaft", length}; }
PlacedTool sphere_link() {
  return {"sphere", 0.0, {Link{"jaw", {LinkPart::sphere(Vector3d::Zero(), kRadius)}}}};
}
PlacedTool box_link() {
  return {"box", 0.0, {Link{"jaw", {LinkPart::box(Isometry3d::Identity(), kBoxSize)}}}};
}

TriangleMesh scaled(GridSurface surface, const Vector3d& scale, const Vector3d& shift) {
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    surface.vertices[i] = static_cast<float>(scale[i % 3] * surface.vertices[i] + shift[i % 3]);
  }
  return {surface.vertices, surface.triangles()};
}

/// A block whose top is in the plane z = 0: 160 mm wide and 60 mm high.
TriangleMesh closed_block(int cells) {
  return scaled(grid_cube(cells, 1.0F / static_cast<float>(cells)), {0.16, 0.16, 0.06},
                {-0.0787, -0.0807, -0.06});
}

Isometry3d pose_at(const Vector3d& place, const Vector3d& rotation = Vector3d::Zero()) {
  const double angle = rotation.norm();
  return Eigen::Translation3d(place) *
         Eigen::AngleAxisd(angle, angle > 0.0 ? rotation.normalized() : Vector3d::UnitX());
}

/// The forces on a tool whose clearance and placement are asked.
std::vector<ForceStep> expect_limited(const PlacedTool& tool,
                                      const std::vector<Isometry3d>& corners,
                                      const TriangleMesh& organ, int resting_steps = 0) {
  const SurfaceTopology topology(organ.faces(), organ.vertices());
  CollisionRequest request;
  request.organ = &organ;
  request.clearance = request.placement = true;
  request.surface_topology = &topology;
  if (tool.links.empty()) request.radius = kRadius;
  if (!tool.links.empty()) request.links = &tool.links;
  std::vector<ToolWaypoint> poses;
  for (const Isometry3d& corner : corners) poses.push_back(tool.at(corner));
  const ShaftRadius radius = tool.links.empty() ? ShaftRadius(kRadius) : std::nullopt;
  return expect_limited(tool.name, request, poses, radius, resting_steps);
}

TEST(ForceInside, OfASunkToolItGrowsOnAlongTheNearestWayOut) {
  struct {
    PlacedTool tool;
    double half;       ///< [m] of its height
    double tilt;       ///< [rad]
    double tolerance;  ///< [m]
  } const rows[] = {
      {shaft(0.05), kRadius, 0.0, 2.0 * kStep},
      {shaft(0.05), kRadius, 0.05, 2.0 * kStep},
      {shaft(0.05), kRadius, -0.11, 2.0 * kStep},
      {sphere_link(), kRadius, 0.0, 4.0 * kStep},
      {box_link(), 0.5 * kBoxSize.z(), 0.0, 4.0 * kStep},
  };
  for (const auto& row : rows) {
    for (const int cells : {4, 11}) {
      const auto at = [&](double z) { return pose_at({0.0031, 0.0017, z}, {row.tilt, 0.0, 0.0}); };
      const auto steps =
          expect_limited(row.tool, {at(0.012), at(-0.019), at(0.012)}, closed_block(cells));
      int inside = 0;
      for (const ForceStep& step : steps) {
        // While the contacts end, the force of a tilted shaft goes from its deeper end, which they
        // report, to the way out of its higher end.
        if (!step.is_inside || (row.tilt != 0.0 && step.distance < 0.003)) continue;
        ++inside;
        const double highest = std::max(step.pose.axis.trocar.z(), step.pose.axis.tip.z());
        EXPECT_LE((step.force - Vector3d(0.0, 0.0, kStiffness * (row.half - highest))).norm(),
                  kStiffness * row.tolerance)
            << row.tool.name;
      }
      EXPECT_GT(inside, 50);
    }
  }
}

TEST(ForceInside, OfAShaftThatIsPushedInWhollyItEndsOnTheNearestWayOut) {
  // Tip first, beyond its trocar. Then the nearest way out is another one than that of the tip.
  const auto at = [](double z) { return pose_at({0.0031, 0.0017, z}, {-0.45 * M_PI, 0.0, 0.0}); };
  const auto steps =
      expect_limited(shaft(0.03), {at(0.04), at(-0.029), at(0.04)}, closed_block(7), 2000);
  const auto deepest = std::min_element(
      steps.rbegin(), steps.rend(), [](auto& a, auto& b) { return lowest_end(a) < lowest_end(b); });
  EXPECT_TRUE(deepest->is_inside);
  EXPECT_NEAR(deepest->force.norm(), kStiffness * (2.0 * kRadius + deepest->distance), 1e-6);
}

TEST(ForceInside, OnRandomWaysItDoesNotJump) {
  oracle::Random random(17);
  const PlacedTool tools[] = {shaft(0.03), sphere_link(), box_link()};
  const TriangleMesh organs[] = {closed_block(5),
                                 scaled(sphere(6, 9, 1.0), {0.06, 0.05, 0.03}, {0.0, 0.0, -0.03})};
  int inside = 0;
  for (int i = 0; i < 18; ++i) {
    const auto random_pose = [&](double z) {
      return pose_at({random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), z},
                     random.point(0.9));
    };
    const std::vector<Isometry3d> corners = {
        random_pose(0.04), random_pose(random.uniform(-0.02, 0.0)),
        random_pose(random.uniform(-0.05, -0.01)), random_pose(0.04)};
    for (const ForceStep& step :
         expect_limited(tools[i % 3], corners, organs[random.integer(0, 1)])) {
      inside += step.is_inside;
    }
  }
  EXPECT_GT(inside, 1000);
}

}  // namespace
}  // namespace organ_collision
