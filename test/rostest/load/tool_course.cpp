#include "tool_course.hpp"

#include <cmath>

namespace organ_collision::stress {
namespace {

constexpr double kReach = 0.01;  // [m] above and below the sheets
constexpr double kTurn = 0.8;    // [rad] to either side
const Eigen::Vector3d kTurningAxis = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();

}  // namespace

ToolPlaces tool_places(double phase) {
  const double height = kReach * std::sin(phase), side = kReach * std::cos(0.3 * phase);
  const Eigen::AngleAxisd turn(kTurn * std::sin(0.7 * phase), kTurningAxis);
  return {{side, 0.0, height},
          {0.0, side, -height},
          {-side, 0.0, height},
          Eigen::Translation3d(side, side, height) * turn};
}

}  // namespace organ_collision::stress
