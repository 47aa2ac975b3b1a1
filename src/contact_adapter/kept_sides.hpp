#pragma once

#include <organ_collision/ContactArray.h>

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "push.hpp"

namespace organ_collision {

/// Remembers on which side a tool first touched each face of an organ, with each of its links.
///
/// A contact's normal and depth have no memory: once the axis has passed a face, they push the tool
/// out on the far side. Here the normal keeps pointing into the tissue from the side of first
/// touch, and the depth keeps growing. The side of a face is forgotten at the first answer without
/// this face, at a static answer (the first one after a reset), and at a new topology. A lost
/// answer changes nothing.
///
/// - As long as the axis is on the side of first touch, normal and depth are the contact's. If the
///   axis is closer to the face than half the radius, the normal lags: see greatest_angle().
/// - Past the face, the normal stays. The depth is s - r (n . m), with the shaft's radius s, the
///   kept normal n, the contact's distance r = s - Contact.depth, and its normal m.
/// - A face that the axis pierces has the contact's depth if the tip pierced it and the two normals
///   agree. If the axis moved into the face from the side, the depth is s: the distance of the tip
///   beyond the face does not matter.
/// - For links, and for a shaft of unknown radius, half the sum of the depths just before and after
///   passing the face takes the place of s. For a sphere, this is its radius. For a link with flat
///   faces, it is half its thickness.
/// - A face that is first touched from inside, by a link that was inside the organ, has the outer
///   side. There the depth is the link's depth just below the surface, less the contact's depth.
class KeptSides {
 public:
  using Radius = std::optional<double>;  ///< [m]
  /// [m] By link: with which depth it is pushed when it is wholly inside, just below the surface.
  /// Twice the radius of a shaft or a sphere.
  using DepthsInside = std::map<std::uint32_t, double>;

  /// One push for each contact, in the order of the contacts. `answer`: the next answer about the
  /// same organ and tool. `shaft_radius`: unset if it is unknown. `inside`: the links that were
  /// inside the organ when the step began.
  std::vector<Push> follow(const ContactArray& answer, const Radius& shaft_radius,
                           const DepthsInside& inside = {});

 private:
  struct Kept {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< as in Push
    double depth = 0.0;                                ///< [m] as in Push
    double depth_in_plane = 0.0;                       ///< [m] with the axis in the face's plane
    std::optional<bool> behind = {};  ///< Contact.behind on the kept side; unset: not known yet
    bool by_tip = false;      ///< the tip was nearest when the axis was last on the kept side
    bool is_nearest = false;  ///< a local minimum by basins_of()
    bool is_past = false;     ///< the axis pierces the face, or is on its other side
  };
  using FaceAndLink = std::pair<std::uint32_t, std::uint32_t>;

  static Kept first_touch(const Contact& contact, const Radius& radius);
  static Kept first_touch_from_inside(const Contact& contact, double depth_inside);
  static void move_on(const Contact& contact, Kept& kept);
  static void move_on(const Contact& contact, double radius, Kept& kept);
  const Kept* find(const Contact& contact) const;
  Kept kept_now(const Contact& contact, const Radius& radius, const DepthsInside& inside) const;

  std::map<FaceAndLink, Kept> kept_;
  std::uint32_t topology_ = 0;
};

}  // namespace organ_collision
