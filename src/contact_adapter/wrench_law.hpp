#pragma once

#include <geometry_msgs/Wrench.h>
#include <organ_collision/ContactArray.h>

#include "contact_motion.hpp"
#include "kept_sides.hpp"

namespace organ_collision {

/// Turns the answers about one organ and one tool into wrenches: the penalty law of the pushes,
/// with a limit on the rate of change of the force.
///
/// The springs of the penalty law appear and vanish suddenly where facets, creases or valleys begin
/// and end under the tool. The limit bridges such jumps: the wrench is interpolated linearly from
/// the last wrench towards the penalty law's wrench, and its force changes in a step by at most
///   stiffness * (4 * motion + 0.05 m/s * seconds),
/// with the motion that ContactMotion finds. Because of the second term, the force reaches the
/// penalty law's force while the tool rests: a lag of stiffness * 1 mm ends within 20 ms. Without
/// contacts the wrench is zero at once.
class WrenchLaw {
 public:
  /// `answer`: the next answer about the same organ and tool. `seconds`: time since the last call.
  /// The limit does not apply to the first answer, a static one, or one with a new topology.
  /// `stiffness` [N/m]. `shaft_radius`: as for KeptSides::follow().
  /// Throws Rejection if the result is not finite.
  geometry_msgs::Wrench follow(const ContactArray& answer, double seconds, double stiffness,
                               const KeptSides::Radius& shaft_radius);

 private:
  KeptSides sides_;
  ContactMotion motion_;
  geometry_msgs::Wrench last_;
};

}  // namespace organ_collision
