#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/messages/conversions.hpp"
#include "haptics/forces.hpp"
#include "pushes.hpp"

namespace organ_collision {

/// Finds from the contacts of two successive answers how far the tool moved relative to the organ.
///
/// The vector from the axis to the nearest point of a face changes by at most the motion of the
/// tool relative to the face, because a projection onto a convex set does not expand distances.
/// Therefore each face gives a lower bound of the motion. The result is the greatest lower bound.
/// Sliding along a plane does not change the vector and is not found.
///
/// - A contact's normal is from first touch in its step, and its depth is from the end of the step.
///   Therefore the change of the vector may come from two steps, and only half of it counts. The
///   change along the normal counts in full.
/// - A face that is newly touched counts with its depth, and so does a face that is left.
/// - A face that the axis pierces in both answers counts with the change of the tip's depth.
/// - For links, and for a shaft of unknown radius, only the change of depth counts, and only while
///   the contact's normal stays: otherwise the depth may have become that of the whole link.
/// - The change of the clearance's distance counts, too, if it is known.
class ContactMotion {
 public:
  /// [m] A lower bound of the motion since the answer of the last call, which has the same
  /// topology. std::nullopt if this answer is the first one. `pushes`: first one for each contact
  /// of the answer, in the same order; further ones are ignored.
  std::optional<double> follow(const ContactArray& answer, const std::vector<Push>& pushes,
                               const ShaftRadius& shaft_radius);

 private:
  /// A touched face.
  struct Place {
    Contact contact;
    Push push;           ///< its depth is at most the radius if the axis came from the side
    ShaftRadius radius;  ///< unset: a link touches, or the radius is not known

    Eigen::Vector3d normal() const { return to_eigen(contact.normal); }
    /// [m] Contact.depth, for a shaft at most its radius.
    double depth() const { return radius ? std::min(contact.depth, *radius) : contact.depth; }
    /// [m] From the axis to the face, if the radius is known.
    Eigen::Vector3d offset() const { return (*radius - depth()) * normal(); }
    /// Whether the axis is past the face, and the push counts.
    bool is_pierced() const { return radius && contact.depth >= *radius && push.counts; }
  };
  using Places = std::map<FaceAndLink, Place>;

  static double path_length_between(const Place& before, const Place& now);
  static double path_length_to(const Place& now);

  std::optional<Places> last_;
  std::optional<double> last_distance_;  ///< [m] Clearance.distance; unset: not known
};

/// Turns the answers about one organ and one tool into forces: the penalty law of the pushes, with
/// a limit on the rate of change of their sum, the force on the tool.
///
/// The limit bridges the jumps where springs appear and vanish: the force at each face is
/// interpolated linearly from the last one towards the penalty law's, and their sum changes in a
/// step by at most
///   stiffness * (4 * motion + 0.05 m/s * seconds),
/// with the motion that ContactMotion finds. If there is no push, the force becomes zero at once.
/// The last force of a face that is no longer in the answer is shared among its faces.
class ForceLaw {
 public:
  /// `way_out`: whether a tool that is wholly inside is pushed out.
  explicit ForceLaw(bool way_out = true) : way_out_(way_out) {}

  /// One force for each push of PushTracker. `answer`: the next answer about the same organ and
  /// tool. A static answer (the first one after a reset) and one with a new topology begin anew:
  /// all that was kept of earlier answers is forgotten, and the limit does not apply. `seconds`:
  /// time since the last call. `stiffness` [N/m]. Throws Rejection if the result is not finite, and
  /// where PushTracker::follow() does.
  std::vector<FaceForce> follow(const ContactArray& answer, double seconds, double stiffness,
                                const ShaftRadius& shaft_radius);

 private:
  void blend_with_last(std::vector<FaceForce>& forces, double share);

  bool way_out_;
  std::uint32_t topology_ = 0;
  PushTracker pushes_{way_out_};
  ContactMotion motion_;
  std::map<FaceAndLink, Eigen::Vector3d> last_;  ///< [N] the forces of the last answer
};

}  // namespace organ_collision
