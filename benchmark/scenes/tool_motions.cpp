#include "tool_motions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "grasper.hpp"

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

constexpr double kDepth = 0.012;  // [m] from the point where the axis enters the organ to the tip

}  // namespace

SceneScale::SceneScale(std::size_t faces)
    : radius(0.005 * std::sqrt(1224.0 / static_cast<double>(std::max<std::size_t>(faces, 1224)))),
      tip_step(2.0 * radius),
      organ_step(0.4 * radius) {}

ShaftMotion ToolMotions::next(const std::vector<float>& vertices) {
  while (true) {
    const Vector3d trocar(either_side(0.1), either_side(0.06), 0.15);
    const Triangle face = corners(organ_, vertices, random_() % organ_.face_count());
    const Vector3d entry = (face[0] + face[1] + face[2]) / 3.0;
    const Vector3d outward = (face[1] - face[0]).cross(face[2] - face[0]).normalized();
    const Vector3d inward = (entry - trocar).normalized();
    if (outward.dot(inward) > -0.5) continue;
    const Vector3d tip = entry + kDepth * inward;
    const Vector3d side = inward.cross(any_vector()).normalized();
    return {{trocar, tip - scale_.tip_step * side}, {trocar, tip}};
  }
}

Vector3d ToolMotions::any_vector() {
  std::uniform_real_distribution<double> symmetric(-1.0, 1.0);
  const double x = symmetric(random_), y = symmetric(random_), z = symmetric(random_);
  return {x, y, z};
}

namespace {

constexpr double kTipStep = 0.001;   // [m] of the grasper, sideways at the point aimed at
constexpr double kJawStep = 0.02;    // [rad] of each jaw in a motion
constexpr double kJawOpening = 0.3;  // [rad] at the start of a motion
constexpr double kReach =
    0.024;  // [m] from the end of the shaft to the point that the motions aim at

ShaftAxis drawn_back(ShaftAxis axis) {
  axis.tip -= kReach * (axis.tip - axis.trocar).normalized();
  return axis;
}

}  // namespace

MotionSet grasper_motions(const OrganSurface& organ, std::size_t count) {
  SceneScale scale(organ.face_count());
  scale.tip_step = kTipStep;
  ToolMotions motions(organ, scale);
  MotionSet set{Grasper::kRadius, Grasper::make_links(), {}};
  for (std::size_t i = 0; i < count; ++i) {
    const ShaftMotion motion = motions.next(organ.vertices);
    set.paths.push_back({Grasper::place(0.0, drawn_back(motion.start), kJawOpening),
                         Grasper::place(1.0, drawn_back(motion.end), kJawOpening - kJawStep)});
  }
  return set;
}

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadiusOfLap = 0.04;  // [m]
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

}  // namespace

// The path is the same for all meshes: it follows the coarsest one.
std::vector<ToolPose> sliding_lap(double depth) {
  const OrganSurface organ = WavingOrgan(1224).middle();
  std::vector<ToolPose> lap;
  for (std::size_t i = 0; i < kLap; ++i) {
    const double around = 2.0 * kPi * static_cast<double>(i) / kLap;
    const double x = kRadiusOfLap * std::cos(around), y = kRadiusOfLap * std::sin(around);
    lap.push_back({{kTrocar, {x, y, height_of(organ, x, y) - depth}}});
  }
  return lap;
}

}  // namespace organ_collision::bench
