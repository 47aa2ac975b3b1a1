#pragma once

#include <organ_collision/ContactArray.h>

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "kept_sides.hpp"

namespace organ_collision {

/// Finds from the contacts of two successive answers how far the tool moved relative to the organ.
///
/// The vector from the axis to the nearest point of a face changes by at most the motion of the
/// tool relative to the face, because a projection onto a convex set does not expand distances.
/// Therefore each face gives a lower bound of the motion, and the result is the greatest of them.
/// Sliding along a plane does not change the vector and is not found.
///
/// - A contact's normal is from first touch in its step, and its depth is from the end of the step.
///   Therefore the change of the vector may come from two steps, and only half of it counts. The
///   change along the normal comes from one step and counts in full.
/// - A face that is newly touched counts with its depth, and so does a face that is left.
/// - A face that the axis pierces in both answers counts with the change of the tip's depth. For a
///   face that is pierced in only one answer, the distance of the tip beyond the face does not
///   count.
/// - For links, and for a shaft of unknown radius, only the change of depth counts, and only while
///   the contact's normal stays. If a face pierces a link with flat faces, the normal and the depth
///   jump to those of the whole link.
/// - If the clearance is known, so does its change. The distance to the nearest face changes by at
///   most the motion.
class ContactMotion {
 public:
  /// [m] A lower bound of the motion since the answer of the last call. std::nullopt if this answer
  /// is the first one, is static, or has another topology. `pushes`: one for each contact of the
  /// answer; others may follow them. `shaft_radius`: as for KeptSides::follow().
  std::optional<double> follow(const ContactArray& answer, const std::vector<Push>& pushes,
                               const KeptSides::Radius& shaft_radius);

 private:
  struct Pierced {
    double depth;  ///< [m] Contact.depth
    double push;   ///< [m] Push.depth: at most the radius if the axis came from the side
  };
  struct Place {
    Eigen::Vector3d normal;                 ///< Contact.normal
    double depth;                           ///< [m] Contact.depth, for a shaft at most its radius
    bool is_new;                            ///< touched in this step, not when it began
    std::optional<Eigen::Vector3d> offset;  ///< [m] axis to face; unset: the radius is unknown
    std::optional<Pierced> pierced;         ///< if the axis is past the face and the push counts
  };
  using FaceAndLink = std::pair<std::uint32_t, std::uint32_t>;
  using Places = std::map<FaceAndLink, Place>;

  static Place place_of(const Contact& contact, const Push& push, const KeptSides::Radius& radius);
  static double path_length_between(const Place& before, const Place& now);
  static double path_length_to(const Contact& contact, const Place& now);

  std::optional<Places> last_;
  std::optional<double> last_distance_;  ///< [m] Clearance.distance; unset: not known
  std::uint32_t topology_ = 0;
};

}  // namespace organ_collision
