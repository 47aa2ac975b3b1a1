// Forces from real queries, step by step along trajectories into closed organs and out again.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "closed_organs.hpp"
#include "contact_adapter/force_law.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "placed_tool.hpp"
#include "test/proof/trials.hpp"

using namespace organ_collision;
using Eigen::Isometry3d;
using Eigen::Vector3d;

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
