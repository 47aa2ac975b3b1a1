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
/// the last one towards that of the penalty law, and its force changes in a step by at most
///   stiffness * (4 * motion + 0.05 m/s * seconds),
/// with the motion that ContactMotion finds. The second term lets the force arrive while the tool
/// rests: a lag of stiffness * 1 mm ends within 20 ms. Without contacts the wrench is zero at once.
class WrenchLaw {
 public:
  /// `answer`: the next one about the same organ and tool. `seconds`: time since the last call. The
  /// limit does not apply to the first answer, to a static one, and to one with a new topology.
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
