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

/// Finds how far a tool moved against an organ between two answers, from their contacts alone.
///
/// The vector from the axis to the nearest point of a face changes by no more than the way of the
/// tool against the face: a projection on a convex set does not expand distances. So each face
/// gives a lower bound of the way, and the greatest is taken. Sliding along a plane does not show.
///
/// - A contact's normal is of the begin of its step, its depth of the end. So the change of that
///   vector is of up to two steps, and half of it is taken. Its part along the normal is of one.
/// - A face that comes to be touched shows its depth, and so does a face that is left.
/// - A face that the axis pierces in both answers shows how much deeper the tip is. How far the tip
///   is beyond a face that the axis pierces in one of them does not show.
/// - Of links, and of a shaft of unknown radius, only the change of depth shows.
class ContactMotion {
 public:
  /// [m] A lower bound of the way since the last call's answer; none where this one is the first,
  /// static, or of another topology. `pushes`: of the answer's contacts; `shaft_radius`: as in
  /// KeptSides.
  std::optional<double> follow(const ContactArray& answer, const std::vector<Push>& pushes,
                               const KeptSides::Radius& shaft_radius);

 private:
  struct Pierced {
    Eigen::Vector3d normal;  ///< Contact.normal
    double depth;            ///< [m] Contact.depth
    double push;  ///< [m] Push.depth: no more than the radius where the axis came from the side
  };
  struct Place {
    double depth;                           ///< [m] Contact.depth, of a shaft at most its radius
    std::optional<Eigen::Vector3d> offset;  ///< [m] from the axis of known radius to the face
    std::optional<Pierced> pierced;         ///< where the axis is past the face, and it counts
  };
  using FaceAndLink = std::pair<std::uint32_t, std::uint32_t>;
  using Places = std::map<FaceAndLink, Place>;

  static Place place_of(const Contact& contact, const Push& push, const KeptSides::Radius& radius);
  static double way_between(const Place& before, const Place& now);

  std::optional<Places> last_;
  std::uint32_t topology_ = 0;
};

}  // namespace organ_collision
