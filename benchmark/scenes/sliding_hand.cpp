#include "sliding_hand.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "grasper.hpp"
#include "waving_organ.hpp"

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadiusOfLap = 0.04;    // [m]
constexpr double kShaftRadius = 0.0015;  // [m]
constexpr double kShaftLength = 0.12;    // [m] of the free shaft
constexpr double kBallRadius = 0.005;    // [m]
constexpr double kReach = 0.024;         // [m] from the grasper's shaft to a point between its jaws
const Vector3d kTrocar(0.1, 0.06, 0.15);

/// The height [m] at which a vertical line meets a face; -infinity if it does not.
double height_in(const Triangle& face, double x, double y) {
  const Vector3d& a = face[0];
  Eigen::Matrix2d edges;
  edges << face[1].x() - a.x(), face[2].x() - a.x(), face[1].y() - a.y(), face[2].y() - a.y();
  const Eigen::Vector2d weights = edges.inverse() * Eigen::Vector2d(x - a.x(), y - a.y());
  const bool is_inside = weights.minCoeff() >= 0.0 && weights.sum() <= 1.0;
  if (!is_inside) return -std::numeric_limits<double>::infinity();
  return a.z() + weights[0] * (face[1].z() - a.z()) + weights[1] * (face[2].z() - a.z());
}

double height_of(const OrganSurface& organ, double x, double y) {
  double height = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < organ.face_count(); ++i)
    height = std::max(height, height_in(corners(organ, organ.vertices, i), x, y));
  return height;
}

ToolPose place(HandTool tool, const Vector3d& tip) {
  const Vector3d direction = (tip - kTrocar).normalized();
  switch (tool) {
    case HandTool::kShaft:
      return {{tip - kShaftLength * direction, tip}};
    case HandTool::kBall:
      return {{tip, tip}, {Eigen::Isometry3d(Eigen::Translation3d(tip))}};
    case HandTool::kGrasper: {
      constexpr double kOpening = 0.3;  // [rad]
      const ToolWaypoint grasper =
          Grasper::place(0.0, {kTrocar, tip - kReach * direction}, kOpening);
      return {grasper.axis, grasper.links};
    }
    case HandTool::kTrocar:
      break;
  }
  return {{kTrocar, tip}};
}

}  // namespace

ProxyTool make_proxy_tool(HandTool tool) {
  switch (tool) {
    case HandTool::kShaft:
      return {kShaftRadius, {}, ProxyFreedom::kFree};
    case HandTool::kBall:
      return {
          0.0, {{"ball", {LinkPart::sphere(Vector3d::Zero(), kBallRadius)}}}, ProxyFreedom::kFree};
    case HandTool::kGrasper:
      return {Grasper::kRadius, Grasper::make_links(), ProxyFreedom::kFree};
    case HandTool::kTrocar:
      break;
  }
  return {kShaftRadius, {}, ProxyFreedom::kTrocar};
}

// The path is the same for all meshes: it follows the coarsest one.
std::vector<ToolPose> sliding_lap(HandTool tool, double depth) {
  const OrganSurface organ = WavingOrgan(1224).middle();
  std::vector<ToolPose> lap;
  for (std::size_t i = 0; i < kLap; ++i) {
    const double around = 2.0 * kPi * static_cast<double>(i) / kLap;
    const double x = kRadiusOfLap * std::cos(around), y = kRadiusOfLap * std::sin(around);
    lap.push_back(place(tool, {x, y, height_of(organ, x, y) - depth}));
  }
  return lap;
}

}  // namespace organ_collision::bench
