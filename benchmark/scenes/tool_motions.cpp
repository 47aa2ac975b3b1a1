#include "tool_motions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

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

}  // namespace organ_collision::bench
