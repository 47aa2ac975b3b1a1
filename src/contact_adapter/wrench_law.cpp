#include "wrench_law.hpp"

#include <Eigen/Core>
#include <optional>

#include "penalty_wrench.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] The allowed change of force, as a multiple of stiffness * motion. A flat surface needs 1, a
/// crease 2, a narrow crease more.
constexpr double kSteepness = 4.0;
/// [m/s] The allowed change of force while the tool rests, divided by stiffness and time.
constexpr double kSettling = 0.05;

Vector3d blend(const geometry_msgs::Vector3& from, const geometry_msgs::Vector3& to, double share) {
  return (1.0 - share) * to_eigen(from) + share * to_eigen(to);
}

}  // namespace

geometry_msgs::Wrench WrenchLaw::follow(const ContactArray& answer, double seconds,
                                        double stiffness, const KeptSides::Radius& shaft_radius) {
  const std::vector<Push> pushes = sides_.follow(answer, shaft_radius);
  const std::optional<double> way = motion_.follow(answer, pushes, shaft_radius);
  geometry_msgs::Wrench wrench = penalty_wrench(pushes, stiffness);
  if (way && !pushes.empty()) {
    const double most = stiffness * (kSteepness * *way + kSettling * seconds);
    const double change = (to_eigen(wrench.force) - to_eigen(last_.force)).norm();
    if (change > most) {
      wrench.force = to_vector(blend(last_.force, wrench.force, most / change));
      wrench.torque = to_vector(blend(last_.torque, wrench.torque, most / change));
    }
  }
  last_ = wrench;
  return wrench;
}

}  // namespace organ_collision
