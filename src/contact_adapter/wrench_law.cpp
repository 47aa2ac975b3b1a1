#include "wrench_law.hpp"

#include <Eigen/Core>
#include <optional>

#include "penalty_wrench.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] Change of force for each stiffness * way. A crease asks for twice, a narrow one for more.
constexpr double kSteepness = 4.0;
/// [m/s] How fast the wrench comes to be the law's while the tool rests.
constexpr double kSettling = 0.05;

Vector3d blend(const geometry_msgs::Vector3& from, const geometry_msgs::Vector3& to, double share) {
  const Vector3d a(from.x, from.y, from.z), b(to.x, to.y, to.z);
  return (1.0 - share) * a + share * b;
}

/// [N] Between the forces of two wrenches.
double apart(const geometry_msgs::Wrench& a, const geometry_msgs::Wrench& b) {
  return Vector3d(a.force.x - b.force.x, a.force.y - b.force.y, a.force.z - b.force.z).norm();
}

}  // namespace

geometry_msgs::Wrench WrenchLaw::follow(const ContactArray& answer, double seconds,
                                        double stiffness, const KeptSides::Radius& shaft_radius) {
  const std::vector<Push> pushes = sides_.follow(answer, shaft_radius);
  const std::optional<double> way = motion_.follow(answer, pushes, shaft_radius);
  geometry_msgs::Wrench wrench = penalty_wrench(pushes, stiffness);
  if (way && !pushes.empty()) {
    const double most = stiffness * (kSteepness * *way + kSettling * seconds);
    const double change = apart(wrench, last_);
    if (change > most) {
      wrench.force = to_vector(blend(last_.force, wrench.force, most / change));
      wrench.torque = to_vector(blend(last_.torque, wrench.torque, most / change));
    }
  }
  last_ = wrench;
  return wrench;
}

}  // namespace organ_collision
