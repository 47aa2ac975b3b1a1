#pragma once

#include <organ_collision/ContactArray.h>

#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

#include "contact_motion.hpp"
#include "forces/face_force.hpp"
#include "kept_sides.hpp"
#include "way_out.hpp"

namespace organ_collision {

/// Turns the answers about one organ and one tool into forces: the penalty law of the pushes, with
/// a limit on the rate of change of their sum, the force on the tool.
///
/// The springs of the penalty law appear and vanish suddenly where facets, creases or valleys begin
/// and end under the tool. The limit bridges such jumps: the force at each face is interpolated
/// linearly from the last one towards the penalty law's, and their sum changes in a step by at most
///   stiffness * (4 * motion + 0.05 m/s * seconds),
/// with the motion that ContactMotion finds. Because of the second term, the force reaches the
/// penalty law's force while the tool rests: a lag of stiffness * 1 mm ends within 20 ms. If there
/// is no push, the force becomes zero at once.
///
/// Forces act only on faces of the answer, where the present places are known. The last force of a
/// face that is no longer among them is shared among those that are.
class ForceLaw {
 public:
  /// `way_out`: whether a tool that is wholly inside is pushed out, see WayOut.
  explicit ForceLaw(bool way_out = true) : way_out_(way_out) {}

  /// One force for each push of WayOut. `answer`: the next answer about the same organ and tool.
  /// `seconds`: time since the last call. The limit does not apply to the first answer, a static
  /// one, or one with a new topology. `stiffness` [N/m]. `shaft_radius`: as for
  /// KeptSides::follow(). Throws Rejection if the result is not finite, and where WayOut::follow()
  /// does.
  std::vector<FaceForce> follow(const ContactArray& answer, double seconds, double stiffness,
                                const KeptSides::Radius& shaft_radius);

 private:
  using FaceAndLink = std::pair<std::uint32_t, std::uint32_t>;

  void blend_with_last(std::vector<FaceForce>& forces, double share);

  WayOut way_out_;
  ContactMotion motion_;
  std::map<FaceAndLink, Eigen::Vector3d> last_;
};

}  // namespace organ_collision
