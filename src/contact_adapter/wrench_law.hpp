#pragma once

#include <geometry_msgs/Wrench.h>
#include <organ_collision/ContactArray.h>

#include "contact_motion.hpp"
#include "kept_sides.hpp"

namespace organ_collision {

/// From the answers about one organ and tool to wrenches: the penalty law of the pushes, with a
/// limit on the force's rate of change.
///
/// Springs appear and end at once where facets, creases or valleys do so under the tool. There the
/// wrench goes straight from the last one towards the law's, and its force changes by at most
///   stiffness * (4 * way + 0.05 m/s * seconds)
/// in a step, with the way that ContactMotion finds. So it arrives when the tool rests, too: a
/// force that lags by stiffness * 1 mm, within 20 ms. Where nothing is touched it is zero at once.
class WrenchLaw {
 public:
  /// `answer` follows on that of the last call, `seconds` before. The first answer, a static one,
  /// and one of a new topology have no limit. `stiffness` [N/m]; `shaft_radius`: as in KeptSides.
  /// Throws Rejection if the result is not finite.
  geometry_msgs::Wrench follow(const ContactArray& answer, double seconds, double stiffness,
                               const KeptSides::Radius& shaft_radius);

 private:
  KeptSides sides_;
  ContactMotion motion_;
  geometry_msgs::Wrench last_;
};

}  // namespace organ_collision
