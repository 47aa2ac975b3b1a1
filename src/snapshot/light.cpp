#include "light.hpp"

#include <algorithm>
#include <cmath>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

const Vector3d kToLight = Vector3d(-0.35, 0.55, 0.75).normalized();
const Vector3d kHalfway = (kToLight + Vector3d::UnitZ()).normalized();  // between light and viewer
constexpr double kAmbient = 0.30;
constexpr double kDiffuse = 0.75;
constexpr double kSpecular = 0.18;
constexpr double kShininess = 30.0;

}  // namespace

Colour lit(const Colour& colour, const Vector3d& normal) {
  // Half of Lambert's light also reaches what faces away, so that no part becomes flat and black.
  const double facing = 0.5 + 0.5 * normal.dot(kToLight);
  const double gloss = std::pow(std::max(0.0, normal.dot(kHalfway)), kShininess);
  const auto light = static_cast<float>(kAmbient + kDiffuse * facing * facing);
  Colour result = colour;
  result.head<3>() = (light * colour.head<3>()).array() + static_cast<float>(kSpecular * gloss);
  return result.cwiseMin(1.0F);
}

}  // namespace organ_collision
